#include "swiftlet/control/flight_controller.hpp"

#include <cstdio>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/control/design/battery_limits.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

// Limits for a battery of another number of cells would land a vehicle at once, or never.
void check_battery_limits(const plant::Vehicle& vehicle, const ControlSettings& settings) {
  const std::vector<double>& open_circuit_v = vehicle.battery.open_circuit_voltage_v;
  const auto check = [&](const char* name, double voltage_v) {
    if (voltage_v > open_circuit_v.front() && voltage_v < open_circuit_v.back()) return;
    char text[192];
    std::snprintf(text, sizeof text,
                  "%s: failsafe.%s is %.2f, must be above %.2f and below %.2f, the battery of %s, or 0",
                  settings.name.c_str(), name, voltage_v, open_circuit_v.front(), open_circuit_v.back(),
                  vehicle.name.c_str());
    throw std::invalid_argument(text);
  };
  const FailsafeSettings failsafe = with_battery_limits(settings.failsafe, vehicle);
  check("low_battery_voltage_v", failsafe.low_battery_voltage);
  check("critical_battery_voltage_v", failsafe.critical_battery_voltage);
}

ControlDesign flyable_design(const plant::Vehicle& vehicle, const ControlSettings& settings) {
  check_battery_limits(vehicle, settings);
  ControlDesign gains = design(vehicle, settings);
  const std::vector<plant::Violation> unstable = unstable_loops(gains);
  if (unstable.empty()) return gains;
  throw std::invalid_argument(settings.name + ": " + unstable.front().key + " " + unstable.front().message);
}

}  // namespace

FlightController::FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings)
    : FlightController(vehicle, settings, flyable_design(vehicle, settings)) {}

FlightController::FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings,
                                   const ControlDesign& design)
    : failsafe_(with_battery_limits(settings.failsafe, vehicle)),
      observers_(vehicle, settings),
      supervisor_({settings.limits, settings.arming, failsafe_}),
      laws_(vehicle, settings, design),
      hover_test_(vehicle) {}

const plant::VehicleCommand& FlightController::on_imu(const plant::ImuSample& sample) {
  return on_imu(sample, no_clients_);
}

const plant::VehicleCommand& FlightController::on_imu(const plant::ImuSample& sample, ClientInputs& clients) {
  begin_anew_if_restarted(sample.stamp_ns);
  return step(sample, observers_.predict(sample, laws_.rotor_state()), clients);
}

const plant::VehicleCommand& FlightController::on_odometry(const plant::OdometrySample& sample) {
  return on_odometry(sample, no_clients_);
}

const plant::VehicleCommand& FlightController::on_odometry(const plant::OdometrySample& sample,
                                                           ClientInputs& clients) {
  begin_anew_if_restarted(sample.stamp_ns);
  const std::optional<plant::ImuSample> motion = observers_.predict(sample, laws_.rotor_state(), situation());
  if (motion) return step(*motion, true, clients);
  plant::ImuSample unusable;
  unusable.stamp_ns = sample.stamp_ns;
  unusable.sequence = sample.sequence;
  return step(unusable, false, clients);
}

// A clock that goes back is that of a restarted vehicle too, while the rotors are off.
void FlightController::begin_anew_if_restarted(std::int64_t stamp_ns) {
  const bool went_back = stamp_ns < observers_.stamp_ns() && laws_.rotor_state() == plant::RotorState::kOff;
  if (!vehicle_restarted_ && !went_back) return;
  observers_.restart();
  obeyed_ns_ = stamp_ns;
  resets_seen_ = 0;
  vehicle_fault_since_ns_ = 0;
  saturated_ns_ = -1;
}

// The estimate has been propagated to the sample, unless it is not usable.
const plant::VehicleCommand& FlightController::step(const plant::ImuSample& sample, bool usable,
                                                    ClientInputs& clients) {
  const double unusable_s = observers_.count_unusable(usable, sample.stamp_ns);
  if (!usable && unusable_s < failsafe_.imu_timeout_s && !vehicle_restarted_) {
    answer(clients);
    return answer_sample(sample);
  }
  const double dt_s = usable ? observers_.store_sample(sample, laws_.command(), level_) : 0.0;

  if (obeyed_) obeyed_ns_ = sample.stamp_ns;

  // Supervision decides the mode, guidance generates the reference.
  const SupervisorInputs now = inputs();
  vehicle_restarted_ = false;
  const ControlSetpoint setpoint = supervisor_.step(now, clients);
  resets_seen_ = now.estimate->resets;
  reference_ = setpoint.reference;
  begin_gain_changes(clients);
  if (laws_.update_gains(observers_.stamp_ns(), rotors_off(supervisor_.mode())))
    observers_.set_gains(laws_.gains());

  // The control laws and the command.
  const Situation situation = this->situation();
  observers_.observe(setpoint, dt_s, situation);
  laws_.step(setpoint, observers_, situation, dt_s);
  if (laws_.saturated()) saturated_ns_ = sample.stamp_ns;
  test_hover(dt_s);
  report(now);
  return answer_sample(sample);
}

const plant::VehicleCommand& FlightController::answer_sample(const plant::ImuSample& sample) {
  observers_.sent(sample.stamp_ns, laws_.thrust_n());
  return laws_.answer(sample, observers_.pose_sequence(), level_);
}

Situation FlightController::situation() const {
  const SupervisorState& state = supervisor_.state();
  return {level_, state.guidance.ground_z_ned, state.contact_since_ns != 0};
}

SupervisorInputs FlightController::inputs() const {
  SupervisorInputs inputs = observers_.supervisor_inputs(situation());
  const std::int64_t now_ns = observers_.stamp_ns();
  inputs.pose_jumped = inputs.estimate->resets != resets_seen_;
  inputs.level = level_;
  inputs.hover_test_defect = hover_test_.defect().data();
  inputs.accepted_levels = accepted_levels_;
  inputs.vehicle_restarted = vehicle_restarted_;
  if (!obeyed_) inputs.not_obeyed_s = math::seconds(now_ns - obeyed_ns_);
  inputs.rotors_running = rotors_running_ || level_ == plant::ControlLevel::kActuators;
  if (vehicle_refusal_[0] != '\0') inputs.vehicle_refusal = vehicle_refusal_.data();
  if (level_ != plant::ControlLevel::kActuators && vehicle_fault_[0] != '\0') {
    inputs.vehicle_fault = vehicle_fault_.data();
    inputs.vehicle_fault_s = math::seconds(now_ns - vehicle_fault_since_ns_);
  }
  const GainChange& change = laws_.gain_change();
  inputs.gains = &change.to;
  inputs.gains_progress = change.progress(now_ns);
  inputs.gains_changing_s = change.remaining_s(now_ns);
  if (saturated_ns_ >= 0) inputs.unsaturated_s = math::seconds(now_ns - saturated_ns_);
  return inputs;
}

void FlightController::test_hover(double dt_s) {
  if (!in_hover_test(supervisor_.state())) {
    // The status tells the defect while the vehicle is stopped.
    if (supervisor_.mode() != Mode::kStopped) hover_test_.reset();
    return;
  }
  if (!(dt_s > 0.0)) return;
  hover_test_.step(observers_.hover_test_step(situation(), dt_s, supervisor_.airborne()));
}

// The supervisor has accepted the request: the gains change from those of this step on.
void FlightController::begin_gain_change(const Request& request, const Outcome& outcome) {
  if (request.kind != RequestKind::kSettings || !outcome.accepted) return;
  laws_.begin_gain_change(*request.gains, observers_.stamp_ns());
}

void FlightController::begin_gain_changes(const ClientInputs& clients) {
  for (std::size_t i = 0; i < clients.request_count; ++i)
    begin_gain_change(*clients.requests[i].request, *clients.requests[i].outcome);
}

void FlightController::report(const SupervisorInputs& inputs) {
  status_.mode = supervisor_.mode();
  status_.reason = supervisor_.reason();
  status_.saturated = laws_.saturated();
  status_.has_pose = inputs.has_estimate && inputs.pose_age_s <= failsafe_.mocap_timeout_s;
  status_.pose_age_s = inputs.pose_age_s;
  status_.airborne = supervisor_.airborne();
  status_.level = level_;
  status_.ground_links = supervisor_.ground_links();
  status_.supply_voltage_v = inputs.supply_voltage_v;
  status_.odometry = {};
  if (const EstimateSource* const odometry = observers_.odometry()) {
    status_.odometry = {odometry->is_vehicles(), odometry->distance_m(), odometry->angle_rad(),
                        odometry->resets_followed()};
  }
  status_.hover_test_defect = hover_test_.defect();
  status_.mission = supervisor_.mission();
  status_.settings = laws_.gain_change().name;
  status_.gains_progress = laws_.gain_change().progress(observers_.stamp_ns());
}

void FlightController::set_vehicle_fault(const VehicleFault& fault) {
  if (vehicle_fault_[0] == '\0') vehicle_fault_since_ns_ = observers_.stamp_ns();
  vehicle_fault_ = fault;
}

void FlightController::set_levels(plant::ControlLevels accepted, std::optional<plant::ControlLevel> wanted) {
  const bool obeyed = laws_.rotor_state() == plant::RotorState::kRunning && accepted.has(level_);
  accepted_levels_ = accepted;
  const plant::ControlLevel level = wanted.value_or(accepted.lowest());
  if (obeyed || level == level_) return;
  level_ = level;
  laws_.idle(observers_, level);
}

void FlightController::answer(ClientInputs& clients) {
  supervisor_.answer(clients, inputs());
  begin_gain_changes(clients);
}

Outcome FlightController::request(const Request& request) {
  const Outcome outcome = supervisor_.request(request, inputs());
  begin_gain_change(request, outcome);
  return outcome;
}

Outcome FlightController::on_setpoint(const Setpoint& setpoint) {
  return supervisor_.setpoint(setpoint, inputs());
}

FlightState FlightController::state() const {
  return {supervisor_.state(),      laws_.position_integral(), laws_.rotor_state(),
          laws_.command().throttle, laws_.gain_change(),       observers_.lift_ratio()};
}

void FlightController::adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory) {
  supervisor_.adopt(state.supervisor, mission, trajectory);
  laws_.adopt(state);
  observers_.adopt(state.lift_ratio, state.supervisor.now_ns);
}

bool FlightController::engage_in_flight() { return supervisor_.engage_in_flight(inputs()).accepted; }

}  // namespace swiftlet::control

#include "swiftlet/control/flight_controller.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/flight_controller_impl.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

// Fraction of the weight: above this specific force that the rotors do not explain, something else carries
// the vehicle, on its legs or on its side.
constexpr double kStandingLift = 0.5;

ControlDesign flyable_design(const plant::Vehicle& vehicle, const ControlSettings& settings) {
  ControlDesign gains = design(vehicle, settings);
  const std::vector<plant::Violation> unstable = unstable_loops(gains);
  if (unstable.empty()) return gains;
  throw std::invalid_argument(settings.name + ": " + unstable.front().key + " " + unstable.front().message);
}

}  // namespace

FlightController::FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings)
    : impl_(std::make_unique<Impl>(vehicle, settings, flyable_design(vehicle, settings))) {}

FlightController::~FlightController() = default;
FlightController::FlightController(FlightController&&) noexcept = default;
FlightController& FlightController::operator=(FlightController&&) noexcept = default;

const plant::VehicleCommand& FlightController::on_imu(const plant::ImuSample& sample) {
  return on_imu(sample, impl_->no_clients);
}

const plant::VehicleCommand& FlightController::on_imu(const plant::ImuSample& sample, ClientInputs& clients) {
  Impl& c = *impl_;
  c.restart_if_clock_went_back(sample.stamp_ns);
  c.brings_odometry = false;
  return c.step(sample, c.predict(sample), clients);
}

const plant::VehicleCommand& FlightController::on_odometry(const plant::OdometrySample& sample) {
  return on_odometry(sample, impl_->no_clients);
}

const plant::VehicleCommand& FlightController::on_odometry(const plant::OdometrySample& sample,
                                                           ClientInputs& clients) {
  Impl& c = *impl_;
  c.restart_if_clock_went_back(sample.stamp_ns);
  c.brings_odometry = true;
  const std::optional<plant::ImuSample> motion = c.predict(sample);
  if (motion) return c.step(*motion, true, clients);
  plant::ImuSample unusable;
  unusable.stamp_ns = sample.stamp_ns;
  unusable.sequence = sample.sequence;
  return c.step(unusable, false, clients);
}

void FlightController::set_vehicle_fault(const VehicleFault& fault) {
  if (impl_->vehicle_fault[0] == '\0') impl_->vehicle_fault_since_ns = impl_->last_stamp_ns;
  impl_->vehicle_fault = fault;
}

void FlightController::set_vehicle_refusal(const VehicleFault& refusal) { impl_->vehicle_refusal = refusal; }

void FlightController::set_rotors_running(bool running) { impl_->rotors_running = running; }

void FlightController::set_obeyed(const plant::ObeyedCommand& obeyed) { impl_->obeyed = obeyed; }

void FlightController::set_levels(plant::ControlLevels accepted, std::optional<plant::ControlLevel> wanted) {
  Impl& c = *impl_;
  const bool obeyed = c.command.rotor_state == plant::RotorState::kRunning && accepted.has(c.level);
  c.accepted_levels = accepted;
  const plant::ControlLevel level = wanted.value_or(accepted.lowest());
  if (obeyed || level == c.level) return;
  c.level = level;
  c.command.throttle = plant::PerRotor{};
  c.send_idle();
}

void FlightController::on_pose(const plant::PoseSample& sample) {
  const std::int64_t now_ns = impl_->estimator.estimate().stamp_ns;
  if (now_ns > 0 && impl_->poses_ahead.keep(sample, now_ns)) return;
  impl_->estimator.correct(sample, impl_->command.rotor_state);
}

void FlightController::on_battery(const plant::BatterySample& sample) {
  if (!impl_->allocator.supply_at(sample.voltage_v).plausible) return;
  impl_->has_battery = true;
  impl_->battery_stamp_ns = sample.stamp_ns;
  impl_->supply_voltage_v = sample.voltage_v;
  impl_->supply_observer.correct(sample.voltage_v);
}

void FlightController::on_rotor_speeds(const plant::RotorSpeedSample& sample) {
  impl_->rotors.correct(sample);
}

bool FlightController::on_ground_heartbeat(const GroundHeartbeat& heartbeat) {
  return impl_->supervisor.ground_heartbeat(heartbeat);
}

void FlightController::answer(ClientInputs& clients) {
  impl_->supervisor.answer(clients, impl_->inputs());
  impl_->begin_gain_changes(clients);
}

Outcome FlightController::request(const Request& request) {
  const Outcome outcome = impl_->supervisor.request(request, impl_->inputs());
  impl_->begin_gain_change(request, outcome);
  return outcome;
}

Outcome FlightController::on_setpoint(const Setpoint& setpoint) {
  return impl_->supervisor.setpoint(setpoint, impl_->inputs());
}

FlightState FlightController::state() const {
  const Impl& l = *impl_;
  return {l.supervisor.state(), l.position.integral(), l.command.rotor_state,
          l.command.throttle,   l.gain_change,         l.lift.lifted_off() ? l.lift.ratio() : 0.0};
}

void FlightController::adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory) {
  Impl& l = *impl_;
  l.supervisor.adopt(state.supervisor, mission, trajectory);
  l.position.adopt(state.position_integral);
  l.command.rotor_state = state.rotor_state;
  l.command.throttle = state.throttle;
  l.gain_change = state.gains;
  l.gains_are_constant = false;
  l.lift.reset();
  if (state.lift_ratio > 0.0) {
    l.lift.adopt(state.lift_ratio);
    l.lift_off_ns = state.supervisor.now_ns;
  }
}

bool FlightController::detects_airborne() const {
  const Impl& l = *impl_;
  const Vector3d lift_frd(0.0, 0.0, -l.lift_now());
  const Vector3d unexplained = l.specific_force_frd - l.estimate().accelerometer_bias - lift_frd;
  return unexplained.norm() < kStandingLift * plant::kGravity;
}

bool FlightController::engage_in_flight() {
  return impl_->supervisor.engage_in_flight(impl_->inputs()).accepted;
}

const Estimate& FlightController::estimate() const { return impl_->estimate(); }
ErrorState FlightController::estimate_deviation() const {
  return impl_->brings_odometry ? impl_->estimate_source.standard_deviation(impl_->estimator)
                                : impl_->estimator.standard_deviation();
}
const Reference& FlightController::reference() const { return impl_->reference; }
const AttitudeSetpoint& FlightController::attitude_setpoint() const { return impl_->attitude_setpoint; }
const Status& FlightController::status() const { return impl_->status; }
const ControlGains& FlightController::gains() const { return impl_->gains; }
const RequestStatuses& FlightController::requests() const { return impl_->supervisor.requests(); }

}  // namespace swiftlet::control

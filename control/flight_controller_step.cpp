// A step of the controller, stage by stage.
#include <algorithm>
#include <cmath>
#include <limits>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/flight_controller_impl.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kFirstStep_s = 0.002;  // assumed for the first sample
constexpr double kMaxStep_s = 0.1;
constexpr int kUnusableToFault = 200;  // unusable IMU samples in a row to a fault, whatever their stamps

// N m about each axis: of rotors in hover, those on one side at no thrust and the others at twice theirs.
Vector3d differential_moment(const plant::Vehicle& vehicle) {
  return plant::effectiveness(vehicle).bottomRows<3>().cwiseAbs().rowwise().sum() *
         plant::hover_thrust(vehicle);
}

}  // namespace

FlightController::Impl::Impl(const plant::Vehicle& vehicle_in, const ControlSettings& settings_in,
                             const ControlDesign& design_in)
    : vehicle(vehicle_in),
      settings(settings_in),
      rotor_lag_s(design_in.rotor_lag_s),
      max_tilt_tangent(std::tan(settings_in.limits.max_tilt_rad)),
      estimator(settings_in.estimator),
      estimate_source(settings_in.estimator.odometry, settings_in.failsafe.mocap_timeout_s),
      poses_ahead(settings_in.estimator.detectors.recovery.longest_wait_s),
      rotors(vehicle_in, settings_in.estimator.rotor_speed_bandwidth),
      disturbance(settings_in.disturbance, settings_in.rough_air.law == DisturbanceLaw::kIncremental),
      moment(vehicle_in.inertia, differential_moment(vehicle_in)),
      takeoff_monitor(settings_in.estimator.detectors.takeoff_consistency),
      position(settings_in.position, settings_in.limits, design_in),
      attitude(vehicle_in, settings_in.attitude, design_in),
      allocator(vehicle_in),
      supervisor({settings_in.limits, settings_in.arming, settings_in.failsafe}),
      supply_voltage_v(allocator.plausible_supply().assumed),
      supply_observer(vehicle_in, supply_voltage_v),
      supply(allocator.supply_at(supply_voltage_v)) {
  command.rotor_count = vehicle.rotor_count();
  sent = command;
  gains = control_gains(design_in, settings_in);
  gain_change.from = gain_change.to = gains;
  gain_change.name = settings_name(settings_in.name);
}

// A restarted vehicle counts its time from 0 again. This is accepted while the rotors are off.
void FlightController::Impl::restart_if_clock_went_back(std::int64_t stamp_ns) {
  const bool rotors_off = command.rotor_state == plant::RotorState::kOff;
  if (stamp_ns >= last_stamp_ns || !rotors_off) return;
  estimator = Estimator(settings.estimator);
  odometry_motion = OdometryMotion();
  estimate_source = EstimateSource(settings.estimator.odometry, settings.failsafe.mocap_timeout_s);
  poses_ahead.clear();
  rotors = RotorObserver(vehicle, settings.estimator.rotor_speed_bandwidth);
  sent_commands = SentCommands();
  resets_seen = 0;
  last_stamp_ns = 0;
  vehicle_fault_since_ns = 0;
  saturated_ns = -1;
  has_battery = false;
}

// Propagates the estimate to the sample, and fuses the poses that waited for it. Returns false for a sample that is not
// usable.
bool FlightController::Impl::predict(const plant::ImuSample& sample) {
  if (!estimator.predict(sample)) return false;
  while (const auto pose = poses_ahead.take(sample.stamp_ns)) estimator.correct(*pose, command.rotor_state);
  return true;
}

// The same with the vehicle's own estimate. Returns it as a sample of an IMU; nullopt if it is not usable.
std::optional<plant::ImuSample> FlightController::Impl::predict(const plant::OdometrySample& sample) {
  const bool finite = sample.q_ned_from_frd.coeffs().allFinite() && sample.body_rates_frd.allFinite();
  if (!finite || sample.stamp_ns <= last_stamp_ns) return std::nullopt;
  const MeanMotion mean = odometry_motion.step(sample, lift_now());
  const plant::ImuSample imu{sample.stamp_ns, sample.sequence, mean.specific_force_frd,
                             sample.body_rates_frd};
  if (!estimator.predict(imu, mean)) return std::nullopt;
  while (const auto pose = poses_ahead.take(sample.stamp_ns)) estimator.correct(*pose, command.rotor_state);
  estimate_source.update(sample, mean.specific_force_frd, estimator, command.rotor_state);
  return imu;
}

// For how long no sample was usable, by the stamps. The count of samples covers a clock that stands still. A
// clock that goes far back is that of a restarted vehicle, which must not receive this flight's commands.
void FlightController::Impl::count_unusable(bool usable, std::int64_t stamp_ns) {
  unusable_samples = usable ? 0 : unusable_samples + 1;
  if (unusable_samples == 1) unusable_since_ns = std::min(stamp_ns, last_stamp_ns);
  unusable_s = usable ? 0.0 : math::seconds(stamp_ns - unusable_since_ns);
  const bool started_again = math::seconds(last_stamp_ns - stamp_ns) > settings.failsafe.imu_timeout_s;
  if (unusable_samples >= kUnusableToFault || started_again)
    unusable_s = std::numeric_limits<double>::infinity();
}

SupervisorInputs FlightController::Impl::inputs() const {
  SupervisorInputs inputs;
  const Estimate& estimate = this->estimate();
  inputs.stamp_ns = estimate.stamp_ns;
  inputs.estimate = &estimate;
  inputs.has_estimate = brings_odometry ? estimate_source.initialised() : estimator.initialised();
  inputs.pose_age_s = brings_odometry ? estimate_source.position_age_s() : estimator.pose_age_s();
  inputs.estimate_of_vehicle = brings_odometry && estimate_source.is_vehicles();
  inputs.brings_odometry = brings_odometry;
  inputs.pose_jumped = estimate.resets != resets_seen;
  inputs.has_battery = has_battery;
  inputs.supply_voltage_v = supply_voltage_v;
  inputs.battery_age_s = math::seconds(estimate.stamp_ns - battery_stamp_ns);
  inputs.vertical_specific_force_residual =
      -(specific_force_frd.z() - estimate.accelerometer_bias.z()) - lift_now();
  if (observes_lift_off()) inputs.lift_off_ns = lift.lifted_off() ? lift_off_ns : kNoLiftOffYet;
  inputs.command_delay_s = sent_commands.delay_s();
  inputs.takeoff_inconsistent = takeoff_monitor.contradicted();
  inputs.specific_force_frd = specific_force_frd;
  inputs.rotor_speed = *std::max_element(rotors.speeds().begin(), rotors.speeds().end());
  inputs.imu_unusable_s = unusable_s;
  inputs.imu_gap_s = imu_gap_s;
  inputs.level = level;
  inputs.accepted_levels = accepted_levels;
  inputs.rotors_running = rotors_running || level == plant::ControlLevel::kActuators;
  if (vehicle_refusal[0] != '\0') inputs.vehicle_refusal = vehicle_refusal.data();
  if (level != plant::ControlLevel::kActuators && vehicle_fault[0] != '\0') {
    inputs.vehicle_fault = vehicle_fault.data();
    inputs.vehicle_fault_s = math::seconds(last_stamp_ns - vehicle_fault_since_ns);
  }
  inputs.gains = &gain_change.to;
  inputs.gains_progress = gain_change.progress(last_stamp_ns);
  inputs.gains_changing_s = gain_change.remaining_s(last_stamp_ns);
  if (saturated_ns >= 0) inputs.unsaturated_s = math::seconds(last_stamp_ns - saturated_ns);
  return inputs;
}

// Stores a usable sample and runs the rotor model up to it. Returns the time since the last sample, s.
double FlightController::Impl::store_sample(const plant::ImuSample& sample) {
  if (!has_battery && last_stamp_ns == 0) battery_stamp_ns = sample.stamp_ns;  // starts the battery time-out
  imu_gap_s = last_stamp_ns == 0 ? kFirstStep_s : math::seconds(sample.stamp_ns - last_stamp_ns);
  const double dt_s = std::min(imu_gap_s, kMaxStep_s);
  last_stamp_ns = sample.stamp_ns;
  specific_force_frd = sample.specific_force_frd;
  sent_commands.sample(sample.stamp_ns, dt_s, obeyed);
  if (level == plant::ControlLevel::kActuators) {
    supply_observer.step(dt_s, command, rotors.speeds());
    supply = allocator.supply_at(supply_observer.voltage_v());
    rotors.step(dt_s, command, supply_observer.voltage_v());
  } else {
    rotors.step(dt_s, sent_commands.obeyed_thrust_n());
  }
  return dt_s;
}

// The supervisor has accepted the request: the gains change from those of this step on.
void FlightController::Impl::begin_gain_change(const Request& request, const Outcome& outcome) {
  if (request.kind != RequestKind::kSettings || !outcome.accepted) return;
  gain_change = *request.gains;
  gain_change.from = gains;
  gain_change.start_ns = last_stamp_ns;
  gains_are_constant = false;
}

void FlightController::Impl::begin_gain_changes(const ClientInputs& clients) {
  for (std::size_t i = 0; i < clients.request_count; ++i)
    begin_gain_change(*clients.requests[i].request, *clients.requests[i].outcome);
}

// Sets the gains of this step in the control laws. With the rotors off they change at once.
void FlightController::Impl::update_gains() {
  if (gains_are_constant) return;
  if (rotors_off(supervisor.mode())) gain_change.duration_s = 0.0;
  gains = gain_change.at(last_stamp_ns);
  position.set_gains(gains);
  attitude.set_gains(gains);
  disturbance.set({gains.disturbance_bandwidth, gains.disturbance_limit});
  gains_are_constant = gain_change.progress(last_stamp_ns) >= 1.0;
  if (gains_are_constant) gain_change.duration_s = 0.0;  // has ended, also for a clock that starts again
}

// Updates the monitor and the observer that run in flight, in every control mode.
void FlightController::Impl::observe(const ControlSetpoint& setpoint, double dt_s) {
  const Estimate& estimate = this->estimate();
  switch (setpoint.control_mode) {
    case ControlMode::kOff:
    case ControlMode::kIdle:
      position.reset();
      disturbance.reset();
      moment.reset();
      lift.reset();
      return;
    case ControlMode::kSpoolUp:
      takeoff_monitor.begin(estimate.accelerometer_bias, estimate.position_ned.z());
      if (!observes_lift_off()) return;
      lift.step_on_ground(dt_s, specific_force_frd - estimate.accelerometer_bias, estimate.q_ned_from_frd,
                          modelled_lift());
      lift_off_ns = last_stamp_ns;
      observe_sliding(dt_s);
      return;
    case ControlMode::kLevelDescent:
      // On the ground the moment comes from the contact, and is no disturbance.
      if (supervisor.state().contact_since_ns == 0) observe_moment(dt_s);
      return;
    case ControlMode::kFly:
    case ControlMode::kAttitude:
    case ControlMode::kBodyRates:
      takeoff_monitor.step(dt_s, specific_force_frd, estimate.q_ned_from_frd, estimate.position_ned.z());
      if (!setpoint.integrate || !controls_position()) return;
      if (settings.rough_air.learn_lift)
        lift.step_in_flight(dt_s, specific_force_frd - estimate.accelerometer_bias, modelled_lift());
      observe_moment(dt_s);
      disturbance.step(dt_s, specific_force_frd - estimate.accelerometer_bias, estimate.q_ned_from_frd,
                       lift_now());
      return;
  }
}

// Needs no position.
void FlightController::Impl::observe_moment(double dt_s) {
  if (settings.rough_air.law == DisturbanceLaw::kIncremental)
    moment.step(dt_s, gains.disturbance_bandwidth, estimate().body_rates_frd, rotors.moment_frd());
}

// On the ground the contact hides the vertical disturbance. The horizontal one shows once the vehicle slides.
void FlightController::Impl::observe_sliding(double dt_s) {
  if (modelled_lift() < LiftObserver::kLeastLift) return;
  const Vector3d force_frd = specific_force_frd - estimate().accelerometer_bias;
  disturbance.step(dt_s, force_frd, estimate().q_ned_from_frd, -force_frd.z());
}

void FlightController::Impl::command_vehicle(const ControlSetpoint& setpoint, const AttitudeDemand& demand) {
  command.rotor_state = plant::RotorState::kRunning;
  if (level == plant::ControlLevel::kActuators) {
    Wrench wrench = inner_loop(demand);
    wrench.moment_frd -= moment.moment_frd();
    wrench.thrust_n += thrust_lead() * (wrench.thrust_n - rotors.thrust_n());
    allocate(demand, wrench);
  } else {
    command_level(setpoint, demand);
  }
}

void FlightController::Impl::command_level(const ControlSetpoint& setpoint, const AttitudeDemand& demand) {
  const Estimate& estimate = this->estimate();
  command.throttle = plant::PerRotor{};
  thrust_n = std::max(demand.rates_only ? demand.thrust_n : thrust_along_body(demand, estimate), 0.0);
  attitude_setpoint = {demand.attitude.body_z_ned, demand.attitude.heading.yaw_rad, thrust_n,
                       Vector3d::Zero()};
  status.saturated = false;  // not known
  if (level == plant::ControlLevel::kRates) {
    send(rates_command(demand, thrust_n, estimate, attitude, settings.limits.max_body_rate));
  } else if (level == plant::ControlLevel::kAttitude) {
    send(attitude_command(demand, thrust_n, estimate));
  } else {
    send(trajectory_command(setpoint, estimate));
  }
}

void FlightController::Impl::allocate(const AttitudeDemand& demand, const Wrench& wrench) {
  const Allocation allocation = allocator.allocate(wrench, supply);
  command.throttle = allocation.throttle;
  attitude_setpoint = {demand.attitude.body_z_ned, demand.attitude.heading.yaw_rad, wrench.thrust_n,
                       wrench.moment_frd};
  status.saturated = allocation.saturated;
}

// Rotors off, or running at throttle 0.
void FlightController::Impl::idle_rotors(plant::RotorState rotor_state) {
  command.rotor_state = rotor_state;
  command.throttle = plant::PerRotor{};
  attitude_setpoint = AttitudeSetpoint();
  status.saturated = false;
  send_idle();
}

void FlightController::Impl::send_idle() {
  if (level == plant::ControlLevel::kActuators) return;
  thrust_n = 0.0;
  send(idle_command(level, estimate()));
}

// The vehicle obeys in the frame of its own estimate.
void FlightController::Impl::send(const plant::VehicleCommand& in_own_frame) {
  sent = brings_odometry ? in_vehicle_frame(in_own_frame, estimate_source) : in_own_frame;
}

void FlightController::Impl::report(const SupervisorInputs& inputs) {
  status.mode = supervisor.mode();
  status.reason = supervisor.reason();
  status.has_pose = inputs.has_estimate && inputs.pose_age_s <= settings.failsafe.mocap_timeout_s;
  status.pose_age_s = inputs.pose_age_s;
  status.airborne = supervisor.airborne();
  status.level = level;
  status.ground_links = supervisor.ground_links();
  status.supply_voltage_v = supply_voltage_v;
  status.odometry = {};
  if (brings_odometry) {
    status.odometry = {estimate_source.is_vehicles(), estimate_source.distance_m(),
                       estimate_source.angle_rad(), estimate_source.resets_followed()};
  }
  status.mission = supervisor.mission();
  status.settings = gain_change.name;
  status.gains_progress = gain_change.progress(last_stamp_ns);
}

const plant::VehicleCommand& FlightController::Impl::stamp_command(const plant::ImuSample& sample) {
  command.stamp_ns = sample.stamp_ns;
  command.imu_sequence = sample.sequence;
  command.mocap_sequence = estimator.pose_sequence();
  ++command.sequence;
  if (level == plant::ControlLevel::kActuators) {
    sent = command;
  } else {
    plant::header_of(sent) = command;
  }
  sent_commands.sent(sample.stamp_ns, thrust_n);
  return sent;
}

// The estimate has been propagated to the sample, unless it is not usable.
const plant::VehicleCommand& FlightController::Impl::step(const plant::ImuSample& sample, bool usable,
                                                          ClientInputs& clients) {
  count_unusable(usable, sample.stamp_ns);
  if (!usable && unusable_s < settings.failsafe.imu_timeout_s) {
    supervisor.answer(clients, inputs());
    begin_gain_changes(clients);
    return stamp_command(sample);
  }
  const double dt_s = usable ? store_sample(sample) : 0.0;

  // Supervision decides the mode, guidance generates the reference.
  const SupervisorInputs now = inputs();
  const ControlSetpoint setpoint = supervisor.step(now, clients);
  resets_seen = now.estimate->resets;
  reference = setpoint.reference;
  begin_gain_changes(clients);
  update_gains();

  // The control laws and the command.
  observe(setpoint, dt_s);
  if (setpoint.control_mode == ControlMode::kOff || setpoint.control_mode == ControlMode::kIdle) {
    idle_rotors(setpoint.control_mode == ControlMode::kOff ? plant::RotorState::kOff
                                                           : plant::RotorState::kRunning);
  } else {
    command_vehicle(setpoint, outer_loop(setpoint, dt_s));
  }
  if (status.saturated) saturated_ns = sample.stamp_ns;
  report(now);
  return stamp_command(sample);
}

}  // namespace swiftlet::control

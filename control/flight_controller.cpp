#include "swiftlet/control/flight_controller.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/attitude/euler.hpp"
#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/estimation/climb_watch.hpp"
#include "swiftlet/control/estimation/disturbance_observer.hpp"
#include "swiftlet/control/estimation/rotor_observer.hpp"
#include "swiftlet/control/position/position_controller.hpp"
#include "swiftlet/control/position/thrust_attitude_map.hpp"
#include "swiftlet/control/supervision/supervisor.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kFirstStep_s = 0.002;  // taken for the first sample, which has none before it
constexpr double kMaxStep_s = 0.1;
constexpr int kUnusableToFault = 200;  // IMU samples in a row that cannot be used, whatever their stamps say
// Of the weight, specific force that the rotors do not explain: something else carries the vehicle, on its
// legs or on its side.
constexpr double kStandingLift = 0.5;
constexpr double kDescentGain = 4.0;   // 1/s, vertical speed to acceleration, in descent without position
constexpr double kBrakeGain = 2.0;     // 1/s, likewise of the horizontal speed
constexpr double kDescentLimit = 2.0;  // m/s^2, of that acceleration

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

ControlDesign flyable_design(const plant::Vehicle& vehicle, const ControlSettings& settings) {
  ControlDesign gains = design(vehicle, settings);
  const std::vector<plant::Violation> unstable = unstable_loops(gains);
  if (unstable.empty()) return gains;
  throw std::invalid_argument(settings.name + ": " + unstable.front().key + " " + unstable.front().message);
}

}  // namespace

struct FlightController::Loops {
  Loops(const plant::Vehicle& vehicle_in, const ControlSettings& settings_in, const ControlDesign& design_in);

  void count_unusable(bool usable, std::int64_t stamp_ns);
  void begin_anew_if_clock_went_back(const plant::ImuSample& sample);
  Situation situation() const;
  void act(const Directive& directive, double dt_s);
  void fly(const Directive& directive, double dt_s);
  void feel(const Directive& directive, double dt_s);
  void fly_attitude(const Directive& directive);
  void fly_body_rates(const Directive& directive);
  void spool_up(const Directive& directive);
  void descend_level(double speed);
  void command_attitude(double thrust_n, const AttitudeReference& attitude_reference);
  void command_wrench(const Wrench& wrench, const AttitudeReference& attitude_reference);
  const plant::ActuatorCommand& answer(const plant::ImuSample& sample);

  plant::Vehicle vehicle;
  ControlSettings settings;
  double rotor_lag_s;
  double max_tilt_tangent;
  Estimator estimator;
  RotorObserver rotors;
  DisturbanceObserver disturbance;
  ClimbWatch climb;
  PositionController position;
  AttitudeController attitude;
  Allocator allocator;
  Supervisor supervisor;

  std::int64_t last_stamp_ns = 0;
  int unusable_samples = 0;            // in a row
  std::int64_t unusable_since_ns = 0;  // the last stamp before them, or that to which time went back
  double unusable_s = 0.0;
  std::uint32_t resets_seen = 0;  // of the estimate, by the supervisor
  double imu_gap_s = 0.0;         // between the last two samples that could be used
  Vector3d specific_force_frd = Vector3d::Zero();
  bool has_battery = false;
  std::int64_t battery_stamp_ns = 0;
  double supply_voltage_v;
  Allocator::Supply supply;
  plant::ActuatorCommand command;
  Reference reference;
  Heading heading;  // of the reference
  AttitudeSetpoint setpoint;
  Status status;
};

FlightController::Loops::Loops(const plant::Vehicle& vehicle_in, const ControlSettings& settings_in,
                               const ControlDesign& design_in)
    : vehicle(vehicle_in),
      settings(settings_in),
      rotor_lag_s(design_in.rotor_lag_s),
      max_tilt_tangent(std::tan(settings_in.limits.max_tilt_rad)),
      estimator(settings_in.estimator),
      rotors(vehicle_in, settings_in.estimator.rotor_speed_bandwidth),
      disturbance(settings_in.disturbance),
      climb(settings_in.estimator.detectors.climb_watch),
      position(settings_in.position, settings_in.limits, design_in),
      attitude(vehicle_in, settings_in.attitude, design_in),
      allocator(vehicle_in),
      supervisor({settings_in.limits, settings_in.arming, settings_in.failsafe}),
      supply_voltage_v(allocator.plausible_supply().assumed),
      supply(allocator.supply_at(supply_voltage_v)) {
  command.rotor_count = vehicle.rotor_count();
}

// A vehicle that was started again counts its time anew; that is believed while the rotors are off.
void FlightController::Loops::begin_anew_if_clock_went_back(const plant::ImuSample& sample) {
  const bool rotors_off = command.rotor_state == plant::RotorState::kOff;
  if (sample.stamp_ns >= last_stamp_ns || !rotors_off) return;
  estimator = Estimator(settings.estimator);
  rotors = RotorObserver(vehicle, settings.estimator.rotor_speed_bandwidth);
  resets_seen = 0;
  last_stamp_ns = 0;
  has_battery = false;
}

// For how long no sample could be used, by their stamps. A clock that stands still does not hide it, and one
// that goes far back is that of a vehicle which was started again: it must not hear the flight's commands.
void FlightController::Loops::count_unusable(bool usable, std::int64_t stamp_ns) {
  unusable_samples = usable ? 0 : unusable_samples + 1;
  if (unusable_samples == 1) unusable_since_ns = std::min(stamp_ns, last_stamp_ns);
  unusable_s = usable ? 0.0 : seconds(stamp_ns - unusable_since_ns);
  const bool started_again = seconds(last_stamp_ns - stamp_ns) > settings.failsafe.imu_timeout_s;
  if (unusable_samples >= kUnusableToFault || started_again)
    unusable_s = std::numeric_limits<double>::infinity();
}

Situation FlightController::Loops::situation() const {
  Situation situation;
  const Estimate& estimate = estimator.estimate();
  situation.stamp_ns = estimate.stamp_ns;
  situation.estimate = &estimate;
  situation.has_estimate = estimator.initialised();
  situation.pose_age_s = estimator.pose_age_s();
  situation.pose_jumped = estimate.resets != resets_seen;
  situation.has_battery = has_battery;
  situation.supply_voltage_v = supply_voltage_v;
  situation.battery_age_s = seconds(estimate.stamp_ns - battery_stamp_ns);
  situation.unexplained_lift =
      -(specific_force_frd.z() - estimate.accelerometer_bias.z()) - rotors.thrust_n() / vehicle.mass_kg;
  situation.climb_contradicted = climb.contradicted();
  situation.specific_force_frd = specific_force_frd;
  situation.rotor_speed = *std::max_element(rotors.speeds().begin(), rotors.speeds().end());
  situation.imu_unusable_s = unusable_s;
  situation.imu_gap_s = imu_gap_s;
  return situation;
}

void FlightController::Loops::act(const Directive& directive, double dt_s) {
  reference = directive.reference;
  command.rotor_state =
      directive.actuation == Actuation::kOff ? plant::RotorState::kOff : plant::RotorState::kRunning;
  switch (directive.actuation) {
    case Actuation::kOff:
    case Actuation::kIdle:
      position.reset();
      disturbance.reset();
      setpoint = AttitudeSetpoint();
      command.throttle = plant::PerRotor{};
      status.saturated = false;
      return;
    case Actuation::kSpoolUp:
      return spool_up(directive);
    case Actuation::kFly:
      feel(directive, dt_s);
      return fly(directive, dt_s);
    case Actuation::kAttitude:
      feel(directive, dt_s);
      return fly_attitude(directive);
    case Actuation::kBodyRates:
      feel(directive, dt_s);
      return fly_body_rates(directive);
    case Actuation::kLevelDescent:
      return descend_level(directive.descent_speed);
  }
}

// What is watched in flight, whichever loop flies.
void FlightController::Loops::feel(const Directive& directive, double dt_s) {
  const Estimate& estimate = estimator.estimate();
  climb.step(dt_s, specific_force_frd, estimate.q_ned_from_frd, estimate.position_ned.z());
  if (!directive.integrate) return;
  disturbance.step(dt_s, specific_force_frd - estimate.accelerometer_bias, estimate.q_ned_from_frd,
                   rotors.thrust_n() / vehicle.mass_kg);
}

// Eq. (48) outside, Eq. (35)-(40) inside.
void FlightController::Loops::fly(const Directive& directive, double dt_s) {
  const Estimate& estimate = estimator.estimate();
  const PositionCommand wanted =
      position.step(estimate.position_ned, estimate.velocity_ned, reference, dt_s, !directive.integrate);
  const ThrustAttitude outer = thrust_attitude(
      vehicle.mass_kg, wanted.acceleration_ned - disturbance.acceleration_ned(), max_tilt_tangent);
  AttitudeReference inner;
  inner.body_z_ned = outer.body_z_ned;
  if (heading.yaw_rad != reference.yaw_rad) heading = reference.yaw_rad;
  inner.heading = heading;
  double thrust_n = outer.thrust_n;
  if (settings.attitude.feed_forward) {
    const ReferenceMotion on_reference = reference_motion(vehicle.mass_kg, reference, inner.heading);
    inner.body_rates = on_reference.body_rates;
    inner.body_accelerations = on_reference.body_accelerations;
    thrust_n += rotor_lag_s * on_reference.thrust_rate;  // leads the rotor lag
  }
  command_attitude(thrust_n, inner);
}

void FlightController::Loops::fly_attitude(const Directive& directive) {
  AttitudeReference wanted;
  wanted.body_z_ned = body_z(directive.q_ned_from_frd);
  wanted.heading = euler_angles(directive.q_ned_from_frd).heading;
  wanted.body_rates = directive.body_rates_frd;
  command_attitude(directive.thrust * vehicle.mass_kg, wanted);
}

void FlightController::Loops::fly_body_rates(const Directive& directive) {
  const Estimate& estimate = estimator.estimate();
  AttitudeReference as_it_is;
  as_it_is.body_z_ned = body_z(estimate.q_ned_from_frd);
  as_it_is.heading = euler_angles(estimate.q_ned_from_frd).heading;
  Wrench wrench;
  wrench.thrust_n = directive.thrust * vehicle.mass_kg;
  wrench.moment_frd =
      attitude.moments_for_rates(estimate.body_rates_frd, rotors.moment_frd(), directive.body_rates_frd);
  command_wrench(wrench, as_it_is);
}

void FlightController::Loops::spool_up(const Directive& directive) {
  climb.begin(estimator.estimate().accelerometer_bias, estimator.estimate().position_ned.z());
  AttitudeReference level;
  level.heading = reference.yaw_rad;
  command_attitude(directive.lift_fraction * vehicle.mass_kg * plant::kGravity, level);
}

void FlightController::Loops::descend_level(double speed) {
  const Estimate& estimate = estimator.estimate();
  Vector3d acceleration_ned = -kBrakeGain * estimate.velocity_ned;
  acceleration_ned.z() = kDescentGain * (speed - estimate.velocity_ned.z());
  acceleration_ned = acceleration_ned.cwiseMax(-kDescentLimit).cwiseMin(kDescentLimit);
  const ThrustAttitude outer = thrust_attitude(vehicle.mass_kg, acceleration_ned, max_tilt_tangent);
  AttitudeReference braking;
  braking.body_z_ned = outer.body_z_ned;
  braking.heading = euler_angles(estimate.q_ned_from_frd).heading;
  command_attitude(outer.thrust_n, braking);
}

// Of the wanted thrust, the part along the axis on which the rotors can give it: none while upside down.
void FlightController::Loops::command_attitude(double thrust_n, const AttitudeReference& attitude_reference) {
  const Estimate& estimate = estimator.estimate();
  const Vector3d body_z_ned = body_z(estimate.q_ned_from_frd);
  Wrench wrench;
  wrench.thrust_n = thrust_n * std::max(attitude_reference.body_z_ned.dot(body_z_ned), 0.0);
  wrench.moment_frd = attitude.moments(estimate.q_ned_from_frd, estimate.body_rates_frd, rotors.moment_frd(),
                                       attitude_reference);
  command_wrench(wrench, attitude_reference);
}

void FlightController::Loops::command_wrench(const Wrench& wrench,
                                             const AttitudeReference& attitude_reference) {
  const Allocation allocation = allocator.allocate(wrench, supply);
  command.throttle = allocation.throttle;
  setpoint = {attitude_reference.body_z_ned, attitude_reference.heading.yaw_rad, wrench.thrust_n,
              wrench.moment_frd};
  status.saturated = allocation.saturated;
}

const plant::ActuatorCommand& FlightController::Loops::answer(const plant::ImuSample& sample) {
  command.stamp_ns = sample.stamp_ns;
  command.imu_sequence = sample.sequence;
  command.mocap_sequence = estimator.pose_sequence();
  ++command.sequence;
  return command;
}

FlightController::FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings)
    : loops_(std::make_unique<Loops>(vehicle, settings, flyable_design(vehicle, settings))) {}

FlightController::~FlightController() = default;
FlightController::FlightController(FlightController&&) noexcept = default;
FlightController& FlightController::operator=(FlightController&&) noexcept = default;

const plant::ActuatorCommand& FlightController::on_imu(const plant::ImuSample& sample) {
  Loops& l = *loops_;
  l.begin_anew_if_clock_went_back(sample);
  const bool usable = l.estimator.predict(sample);
  l.count_unusable(usable, sample.stamp_ns);
  if (!usable && l.unusable_s < l.settings.failsafe.imu_timeout_s) return l.answer(sample);

  double dt_s = 0.0;
  if (usable) {
    if (!l.has_battery && l.last_stamp_ns == 0)
      l.battery_stamp_ns = sample.stamp_ns;  // it is awaited from here
    l.imu_gap_s = l.last_stamp_ns == 0 ? kFirstStep_s : seconds(sample.stamp_ns - l.last_stamp_ns);
    dt_s = std::min(l.imu_gap_s, kMaxStep_s);
    l.last_stamp_ns = sample.stamp_ns;
    l.specific_force_frd = sample.specific_force_frd;
    l.rotors.step(dt_s, l.command, l.supply_voltage_v);
  }
  const Situation situation = l.situation();
  const Directive directive = l.supervisor.step(situation);
  l.resets_seen = situation.estimate->resets;
  l.act(directive, dt_s);

  l.status.mode = l.supervisor.mode();
  l.status.reason = l.supervisor.reason();
  l.status.has_pose = situation.has_estimate && situation.pose_age_s <= l.settings.failsafe.mocap_timeout_s;
  l.status.pose_age_s = situation.pose_age_s;
  l.status.airborne = l.supervisor.airborne();
  l.status.ground_links = l.supervisor.ground_links();
  l.status.supply_voltage_v = l.supply_voltage_v;
  l.status.mission = l.supervisor.mission();
  return l.answer(sample);
}

void FlightController::on_pose(const plant::PoseSample& sample) {
  loops_->estimator.correct(sample, loops_->command.rotor_state);
}

void FlightController::on_battery(const plant::BatterySample& sample) {
  const Allocator::Supply supply = loops_->allocator.supply_at(sample.voltage_v);
  if (!supply.plausible) return;
  loops_->has_battery = true;
  loops_->battery_stamp_ns = sample.stamp_ns;
  loops_->supply_voltage_v = sample.voltage_v;
  loops_->supply = supply;
}

void FlightController::on_rotor_speeds(const plant::RotorSpeedSample& sample) {
  loops_->rotors.correct(sample);
}

Outcome FlightController::on_setpoint(const Setpoint& setpoint) {
  return loops_->supervisor.setpoint(setpoint, loops_->situation());
}

bool FlightController::on_ground_sign(const GroundSign& sign) { return loops_->supervisor.ground_sign(sign); }

Outcome FlightController::request(const Request& request) {
  return loops_->supervisor.request(request, loops_->situation());
}

FlightState FlightController::state() const {
  const Loops& l = *loops_;
  return {l.supervisor.state(), l.position.integral(), l.command.rotor_state, l.command.throttle};
}

void FlightController::adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory) {
  Loops& l = *loops_;
  l.supervisor.adopt(state.supervisor, mission, trajectory);
  l.position.adopt(state.position_integral);
  l.command.rotor_state = state.rotor_state;
  l.command.throttle = state.throttle;
}

bool FlightController::feels_airborne() const {
  const Loops& l = *loops_;
  const Vector3d lift_frd(0.0, 0.0, -l.rotors.thrust_n() / l.vehicle.mass_kg);
  const Vector3d unexplained = l.specific_force_frd - l.estimator.estimate().accelerometer_bias - lift_frd;
  return unexplained.norm() < kStandingLift * plant::kGravity;
}

bool FlightController::find_flying() { return loops_->supervisor.find_flying(loops_->situation()).accepted; }

const Estimate& FlightController::estimate() const { return loops_->estimator.estimate(); }
ErrorState FlightController::estimate_deviation() const { return loops_->estimator.standard_deviation(); }
const Reference& FlightController::reference() const { return loops_->reference; }
const AttitudeSetpoint& FlightController::attitude_setpoint() const { return loops_->setpoint; }
const Status& FlightController::status() const { return loops_->status; }

}  // namespace swiftlet::control

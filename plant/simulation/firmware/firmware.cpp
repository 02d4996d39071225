#include "swiftlet/plant/simulation/firmware/firmware.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/battery.hpp"

namespace swiftlet::plant {
namespace {

constexpr double kFlyingThrust = 0.5;  // of the weight: below it the vehicle stands, and no integral advances
constexpr double kNoThrust = 0.02;     // of the weight: below it the rotors idle
// The thrust without a command, as a share of the weight. A vehicle that is 20 % lighter than the model does not climb with it.
constexpr double kSinkingThrust = 0.8;
constexpr double kLongestStep_s = 0.05;

}  // namespace

Firmware::Firmware(const Vehicle& vehicle, const SimulationSettings& settings)
    : rotor_count_(vehicle.rotor_count()),
      weight_n_(vehicle.mass_kg * kGravity),
      nominal_step_s_(1.0 / settings.imu.rate_hz),
      needs_poses_(settings.odometry.source == OdometrySource::kMocap ||
                   settings.control_levels.has(ControlLevel::kAttitude) ||
                   settings.control_levels.has(ControlLevel::kTrajectory)),
      watchdog_(vehicle.rotor_count(), math::nanoseconds(settings.command_timeout_s), settings.control_levels,
                math::nanoseconds(settings.command_hold_s)),
      position_loop_(firmware_gains(vehicle).position, vehicle.mass_kg),
      attitude_loop_(firmware_gains(vehicle).attitude),
      rate_loop_(firmware_gains(vehicle).rates, vehicle.inertia),
      mixer_(vehicle),
      supply_voltage_v_(open_circuit_voltage(vehicle.battery, settings.supply.initial_state_of_charge)) {}

void Firmware::on_imu(const ImuSample& sample) {
  dt_s_ = last_stamp_ns_ < 0 ? nominal_step_s_
                             : std::clamp(1e-9 * static_cast<double>(sample.stamp_ns - last_stamp_ns_), 1e-4,
                                          kLongestStep_s);
  last_stamp_ns_ = sample.stamp_ns;
  new_imu_ = sample;
  if (needs_poses_ && is_finite(sample)) estimator_.predict(sample, dt_s_);
}

bool Firmware::is_finite(const ImuSample& sample) const {
  return sample.body_rates_frd.allFinite() && sample.specific_force_frd.allFinite();
}

void Firmware::on_battery(const BatterySample& sample) { supply_voltage_v_ = sample.voltage_v; }

void Firmware::on_pose(const PoseSample& sample) {
  if (needs_poses_) new_pose_ = sample;
}

const MotorCommand& Firmware::motor_command(std::int64_t now_ns) {
  const MotorCommand& obeyed = watchdog_.motor_command(now_ns);
  if (new_imu_) run_loops(now_ns);
  if (level_of(watchdog_.command()) == ControlLevel::kActuators || obeyed.state == RotorState::kOff) {
    reset_loops();
    return motor_command_ = obeyed;
  }
  motor_command_.state = obeyed.state;
  return motor_command_;
}

// The motor command of the loops; in force if the rotors are to run.
void Firmware::run_loops(std::int64_t now_ns) {
  const ImuSample& imu = *new_imu_;
  if (new_pose_) estimator_.correct(*new_pose_);
  new_pose_.reset();
  const VehicleCommand& command = watchdog_.command();
  const ControlLevel level = level_of(command);
  if (level != ControlLevel::kActuators && header_of(command).rotor_state == RotorState::kRunning &&
      is_finite(imu)) {
    const VehicleCommand obeyed = watchdog_.outdated(now_ns) ? without_command(level) : command;
    const RatesAndThrust wanted = std::visit([this](const auto& one) { return rates_for(one); }, obeyed);
    carries_ = wanted.thrust_n >= kFlyingThrust * weight_n_;
    Eigen::Vector3d moment_frd = rate_loop_.step(wanted.body_rates_frd, imu.body_rates_frd, dt_s_, carries_);
    if (wanted.thrust_n < kNoThrust * weight_n_) moment_frd.setZero();
    motor_command_.throttle = mixer_.throttles(wanted.thrust_n, moment_frd, supply_voltage_v_);
  }
  new_imu_.reset();
}

Firmware::RatesAndThrust Firmware::rates_for(const ActuatorCommand&) { return {}; }

Firmware::RatesAndThrust Firmware::rates_for(const RatesSetpoint& setpoint) {
  return {setpoint.body_rates_frd, setpoint.thrust_n};
}

Firmware::RatesAndThrust Firmware::rates_for(const AttitudeSetpoint& setpoint) {
  return {attitude_loop_.step(setpoint.q_ned_from_frd, setpoint.body_rates_frd, attitude()),
          setpoint.thrust_n};
}

Firmware::RatesAndThrust Firmware::rates_for(const TrajectorySetpoint& setpoint) {
  const AttitudeAndThrust wanted = position_loop_.step(
      setpoint, odometry_ ? odometry_->position_ned : estimator_.position_ned(),
      odometry_ ? odometry_->velocity_ned : estimator_.velocity_ned(), attitude(), dt_s_, carries_);
  const Eigen::Vector3d yaw_rate_ned = setpoint.yaw_rate * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d rates_ahead = wanted.q_ned_from_frd.conjugate() * yaw_rate_ned;
  return {attitude_loop_.step(wanted.q_ned_from_frd, rates_ahead, attitude()), wanted.thrust_n};
}

// In flight: no rates, level at the present heading, or at rest. On the ground the rotors idle.
VehicleCommand Firmware::without_command(ControlLevel level) const {
  const double thrust_n = carries_ ? kSinkingThrust * weight_n_ : 0.0;
  if (level == ControlLevel::kRates) {
    RatesSetpoint still;
    still.thrust_n = thrust_n;
    return still;
  }
  const Eigen::Vector3d forward_ned = attitude() * Eigen::Vector3d::UnitX();
  const double yaw_rad = std::atan2(forward_ned.y(), forward_ned.x());
  if (level == ControlLevel::kAttitude) {
    AttitudeSetpoint upright;
    upright.q_ned_from_frd = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ());
    upright.thrust_n = thrust_n;
    return upright;
  }
  TrajectorySetpoint at_rest;
  at_rest.yaw_rad = yaw_rad;
  if (!carries_) at_rest.acceleration_ned.z() = kGravity;
  return at_rest;
}

void Firmware::reset_loops() {
  position_loop_.reset();
  rate_loop_.reset();
  carries_ = false;
}

ActuatorCommand Firmware::as_actuators(const VehicleCommand& command) const {
  if (const auto* throttles = std::get_if<ActuatorCommand>(&command)) return *throttles;
  ActuatorCommand out;
  static_cast<CommandHeader&>(out) = header_of(command);
  out.rotor_count = rotor_count_;
  if (out.rotor_state == RotorState::kRunning) out.throttle = motor_command_.throttle;
  return out;
}

}  // namespace swiftlet::plant

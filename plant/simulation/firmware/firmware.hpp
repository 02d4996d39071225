// The flight-control firmware of the simulated vehicle: obeys commands at the levels that the vehicle accepts. At level
// actuators it passes the throttles on. At the others it runs its own loops once per IMU sample, a cascade as of
// Crazyflie and PX4: position and velocity, attitude, body rates, mixer. When commands cease, it obeys the last one for
// command_hold_s. Then it levels itself and sinks with what its loops know, and after command_timeout_s the rotors stop.
//
//   firmware.on_imu(sample);                                  // each sample of the vehicle's IMU
//   firmware.accept(command, now_ns);                         // each command that arrives
//   plant.step(firmware.motor_command(now_ns));               // each integration step
//
// Pure: no clock, no heap after construction.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/command_watchdog.hpp"
#include "swiftlet/plant/simulation/firmware/attitude_loop.hpp"
#include "swiftlet/plant/simulation/firmware/gains.hpp"
#include "swiftlet/plant/simulation/firmware/mixer.hpp"
#include "swiftlet/plant/simulation/firmware/onboard_estimator.hpp"
#include "swiftlet/plant/simulation/firmware/position_loop.hpp"
#include "swiftlet/plant/simulation/firmware/rate_loop.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"

namespace swiftlet::plant {

class Firmware {
 public:
  // Accepts settings.control_levels. Precondition: validate() finds no violation.
  Firmware(const Vehicle& vehicle, const SimulationSettings& settings);

  // The newest samples; the estimator is propagated at once, the loops run with the next motor_command().
  void on_imu(const ImuSample& sample);
  // The vehicle's own estimate at this IMU sample, in place of that of the on-board estimator.
  void on_odometry(const OdometrySample& sample) { odometry_ = sample; }
  void on_battery(const BatterySample& sample);
  // Needed at levels attitude and trajectory.
  void on_pose(const PoseSample& sample);
  bool needs_poses() const { return needs_poses_; }

  // As CommandWatchdog.
  CommandFault accept(const VehicleCommand& command, std::int64_t now_ns) {
    return watchdog_.accept(command, now_ns);
  }
  bool outdated(std::int64_t now_ns) const { return watchdog_.outdated(now_ns); }
  bool expired(std::int64_t now_ns) const { return watchdog_.expired(now_ns); }
  ObeyedCommand obeyed() const { return watchdog_.obeyed(); }

  const MotorCommand& motor_command(std::int64_t now_ns);
  RotorState rotor_state(std::int64_t now_ns) const { return watchdog_.motor_command(now_ns).state; }

  // For records: this command as one of level actuators. Those of other levels have the throttles that the loops gave
  // last.
  ActuatorCommand as_actuators(const VehicleCommand& command) const;

  const OnboardEstimator& estimator() const { return estimator_; }
  const RateLoop& rate_loop() const { return rate_loop_; }
  const PositionLoop& position_loop() const { return position_loop_; }

 private:
  struct RatesAndThrust {
    Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();
    double thrust_n = 0.0;
  };
  void run_loops(std::int64_t now_ns);
  bool is_finite(const ImuSample& sample) const;
  const Eigen::Quaterniond& attitude() const {
    return odometry_ ? odometry_->q_ned_from_frd : estimator_.q_ned_from_frd();
  }
  RatesAndThrust rates_for(const ActuatorCommand& command);
  RatesAndThrust rates_for(const RatesSetpoint& setpoint);
  RatesAndThrust rates_for(const AttitudeSetpoint& setpoint);
  RatesAndThrust rates_for(const TrajectorySetpoint& setpoint);
  VehicleCommand without_command(ControlLevel level) const;
  void reset_loops();

  int rotor_count_;
  double weight_n_;
  double nominal_step_s_;
  bool needs_poses_;
  CommandWatchdog watchdog_;
  OnboardEstimator estimator_;
  PositionLoop position_loop_;
  AttitudeLoop attitude_loop_;
  RateLoop rate_loop_;
  Mixer mixer_;

  std::optional<ImuSample> new_imu_;
  std::optional<PoseSample> new_pose_;
  std::optional<OdometrySample> odometry_;
  double supply_voltage_v_;
  std::int64_t last_stamp_ns_ = -1;
  double dt_s_ = 0.0;     // of the present run of the loops
  bool carries_ = false;  // the last thrust was enough that the vehicle flies: integrals advance
  MotorCommand motor_command_;
};

}  // namespace swiftlet::plant

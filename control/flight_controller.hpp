// The whole controller as pure code: samples and requests in, actuator commands out. No clock, no I/O, no
// threads, no heap after construction; time is what the samples' stamps say. One thread calls it.
#pragma once

#include <cstdint>
#include <memory>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/flight_state.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// What each step asked of the inner loop, for plots and logs.
struct AttitudeSetpoint {
  Eigen::Vector3d body_z_ned = Eigen::Vector3d::UnitZ();  // unit length
  double yaw_rad = 0.0;
  double thrust_n = 0.0;
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m
};

class FlightController {
 public:
  // Designs all gains. Throws std::invalid_argument with a sentence if the vehicle or the settings break a
  // rule.
  FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings);
  ~FlightController();
  FlightController(FlightController&&) noexcept;
  FlightController& operator=(FlightController&&) noexcept;

  // One step of the inner loop: the command that answers this sample. A sample that is not finite or not
  // newer than the last one is not used; the command then repeats the last. The answer stays until the next.
  const plant::ActuatorCommand& on_imu(const plant::ImuSample& sample);

  void on_pose(const plant::PoseSample& sample);
  void on_battery(const plant::BatterySample& sample);
  void on_rotor_speeds(const plant::RotorSpeedSample& sample);
  // Setpoints are followed while holding; a refused one changes nothing.
  Outcome on_setpoint(const Setpoint& setpoint);
  // A sign of life of a ground tool. False if the flight depends on too many others already.
  bool on_ground_heartbeat(const GroundHeartbeat& sign);
  // Answers by the present mode. A mission or trajectory must have passed check() of planning/checks.hpp
  // before.
  Outcome request(const Request& request);

  // The flight, for another controller of the same vehicle and settings to go on with, in its next step. What
  // is being flown is passed beside it, as in Supervisor::adopt().
  FlightState state() const;
  void adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory);
  // The air carries the vehicle, as far as accelerometer and rotor speeds tell: it does not stand.
  bool detects_airborne() const;
  // Takes a vehicle that flies already into hold; false, and changes nothing, without a pose.
  bool engage_in_flight();

  // As of the last step.
  const Estimate& estimate() const;
  ErrorState estimate_deviation() const;  // Estimator::standard_deviation()
  const Reference& reference() const;
  const AttitudeSetpoint& attitude_setpoint() const;
  const Status& status() const;
  // As of now: what has become of the requests that were accepted last.
  const RequestStatuses& requests() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::control

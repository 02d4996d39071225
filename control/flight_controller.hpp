// The whole controller as pure code: samples and requests in, commands of the vehicle out. No clock, no I/O, no
// threads, no heap allocation after construction. Time is the samples' stamps. One thread calls it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/flight_state.hpp"
#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"

namespace swiftlet::control {

// The setpoint of the inner loop in each step, for plots and logs.
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

  // One step of the inner loop. Returns the command for this sample. A sample that is not finite or not
  // newer than the last is not used, and the last command is repeated. The returned reference stays valid
  // until the next call. Requests and setpoints are accepted or refused in every step, by the mode and the
  // estimate at its sample. A refused one changes nothing. A mission or trajectory must have passed check()
  // of planning/checks.hpp before; setpoints are accepted in holding and setpoint mode.
  const plant::VehicleCommand& on_imu(const plant::ImuSample& sample);
  const plant::VehicleCommand& on_imu(const plant::ImuSample& sample, ClientInputs& clients);

  // The same with the vehicle's own estimate in place of the IMU, of a vehicle that brings it. By which estimate it is flown is
  // a setting; poses correct that of motion capture as with an IMU. Needs a level above actuators: at that one, arming is
  // refused. Attitudes and trajectories are sent in the frame of the vehicle's estimate.
  const plant::VehicleCommand& on_odometry(const plant::OdometrySample& sample);
  const plant::VehicleCommand& on_odometry(const plant::OdometrySample& sample, ClientInputs& clients);

  // The levels that the vehicle accepts, and the one at which it is to be commanded; nullopt: the lowest of them.
  // Without a call the vehicle is commanded at level actuators. Rotors that turn on commands of an accepted level
  // keep it. At a level that the vehicle does not accept, arming is refused.
  //
  // Estimator, supervision, guidance and failsafes work alike at every level; so does the position law except at
  // level trajectory. What the vehicle controls itself is not integrated here: at level trajectory position integral
  // and disturbance observer stand still. Without throttles, the rotors are taken to give the commanded collective
  // thrust, at level trajectory that of the position law.
  void set_levels(plant::ControlLevels accepted, std::optional<plant::ControlLevel> wanted);

  // What the vehicle reports as fault in vehicle_info, from the next step on; empty: none. At other levels than actuators a
  // flight is stopped after 0.5 s of one, and none begins.
  void set_vehicle_fault(const VehicleFault& fault);
  // Why the vehicle must not be armed, a sentence; empty: it may. Has no effect in flight.
  void set_vehicle_refusal(const VehicleFault& refusal);

  // What the vehicle reports of its rotors in vehicle_info, from the next step on. At other levels than actuators a take-off begins
  // when they run: a vehicle with an arming of its own starts them later than it is told to. Without a call they run when told to.
  void set_rotors_running(bool running);

  // The command that the vehicle obeyed when it took the next sample, as it reports with it. Without a call, or without that report, it
  // is taken to obey the newest one: over a link with delay the lift that is learnt is then wrong.
  void set_obeyed(const plant::ObeyedCommand& obeyed);

  void on_pose(const plant::PoseSample& sample);
  void on_battery(const plant::BatterySample& sample);
  void on_rotor_speeds(const plant::RotorSpeedSample& sample);
  // Returns false if the link-loss failsafe is on for too many other clients already.
  bool on_ground_heartbeat(const GroundHeartbeat& heartbeat);

  // While simulated time stands still: answers clients as on_imu() does, at the last sample.
  void answer(ClientInputs& clients);
  Outcome request(const Request& request);
  Outcome on_setpoint(const Setpoint& setpoint);

  // The state of the flight. Another controller of the same vehicle and settings adopts it and continues in
  // its next step, with the gains in force and a change of them under way. The mission and trajectory being
  // flown are passed separately, as in Supervisor::adopt().
  FlightState state() const;
  void adopt(const FlightState& state, const Mission* mission, const Trajectory* trajectory);
  // True if the vehicle flies, by accelerometer and rotor speeds: nothing but the rotors carries it.
  bool detects_airborne() const;
  // Brings a vehicle that is already flying into hold. Returns false without a pose, and changes nothing.
  bool engage_in_flight();

  // Values of the last step.
  const Estimate& estimate() const;
  ErrorState estimate_deviation() const;  // Estimator::standard_deviation()
  const Reference& reference() const;
  const AttitudeSetpoint& attitude_setpoint() const;
  const Status& status() const;
  const ControlGains& gains() const;  // in force
  // Current status of the requests that were accepted last.
  const RequestStatuses& requests() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::control

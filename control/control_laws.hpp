// The control laws: from a setpoint and what the observers know to the command of the vehicle. The outer loop of each control mode
// (position, Eq. (48)), the inner one (attitude, Eq. (35)-(40)) and the allocation, or the command of a level above actuators.
//
// In: setpoint in NED, m and s; observers; gains. Out: command(), sent() and attitude_setpoint(), with thrusts in N, moments in N m.
// No clock, no heap after construction.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/flight_state.hpp"
#include "swiftlet/control/level_commands.hpp"
#include "swiftlet/control/observers.hpp"
#include "swiftlet/control/position/position_controller.hpp"
#include "swiftlet/control/supervision/supervisor_inputs.hpp"
#include "swiftlet/control/types/gains.hpp"
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

class ControlLaws {
 public:
  ControlLaws(const plant::Vehicle& vehicle, const ControlSettings& settings, const ControlDesign& design);

  // The command for a setpoint, dt_s after the last.
  void step(const ControlSetpoint& setpoint, const Observers& observers, const Situation& situation,
            double dt_s);
  // Throttle 0, with the rotors as they are.
  void idle(const Observers& observers, plant::ControlLevel level);
  // The command as the answer to the sample. Valid until the next call.
  const plant::VehicleCommand& answer(const plant::ImuSample& sample, std::uint64_t pose_sequence,
                                      plant::ControlLevel level);

  // The gains change from those in force.
  void begin_gain_change(const GainChange& change, std::int64_t now_ns);
  // Sets the gains of this step. With the rotors off they change at once. Returns false while they are constant.
  bool update_gains(std::int64_t now_ns, bool rotors_off);
  const ControlGains& gains() const { return gains_; }  // in force
  const GainChange& gain_change() const { return gain_change_; }

  // Continues the flight of another controller: its command, gains and integral.
  void adopt(const FlightState& state);
  const Eigen::Vector3d& position_integral() const { return position_.integral(); }  // m/s^2, NED

  const plant::ActuatorCommand& command() const { return command_; }  // at other levels without throttles
  plant::RotorState rotor_state() const { return command_.rotor_state; }
  double thrust_n() const { return thrust_n_; }  // collective thrust of the command, at other levels
  const AttitudeSetpoint& attitude_setpoint() const { return attitude_setpoint_; }
  bool saturated() const { return saturated_; }  // the rotors' limits cut the last command

 private:
  // What a step is computed from.
  struct Inputs {
    const ControlSetpoint& setpoint;
    const Observers& observers;
    const Situation& situation;
    const Estimate& estimate;
    double dt_s;
  };

  AttitudeDemand outer_loop(const Inputs& in);
  AttitudeDemand follow_reference(const Inputs& in, bool integrate);
  AttitudeDemand spool_up(const Inputs& in);
  AttitudeDemand descend_level(const Inputs& in) const;
  AttitudeDemand follow_direct_setpoint(const Inputs& in) const;
  Wrench inner_loop(const Inputs& in, const AttitudeDemand& demand) const;
  void allocate(const Inputs& in, const AttitudeDemand& demand);
  void command_level(const Inputs& in, const AttitudeDemand& demand);
  void send(const plant::VehicleCommand& in_own_frame, const Observers& observers);
  Eigen::Vector3d expected_disturbance(const Observers& observers) const;
  double thrust_lead(const Situation& situation) const;

  double mass_kg_;
  double rotor_lag_s_;
  double max_tilt_tangent_;
  double max_body_rate_;
  bool feed_forward_;
  RoughAirSettings rough_air_;
  PositionController position_;
  AttitudeController attitude_;
  Allocator allocator_;

  GainChange gain_change_;
  ControlGains gains_;
  bool gains_are_constant_ = true;  // and set in the control laws

  plant::ActuatorCommand command_;
  double thrust_n_ = 0.0;
  plant::VehicleCommand sent_;  // the command at the level
  math::Heading heading_;       // of the reference's yaw
  AttitudeSetpoint attitude_setpoint_;
  bool saturated_ = false;
};

}  // namespace swiftlet::control

// The commands of a vehicle that closes its inner loops itself, at the levels rates, attitude and trajectory. What each
// level means is in docs/vehicle.md.
#pragma once

#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/control/estimation/estimate_source.hpp"
#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/supervision/supervisor_inputs.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle_command.hpp"

namespace swiftlet::control {

// The output of the outer loop, for the inner one.
struct AttitudeDemand {
  double thrust_n = 0.0;
  AttitudeReference attitude;
  bool rates_only = false;  // body rates are controlled, the attitude is not
};

// The part of the demanded thrust along the present body axis, N; none while upside down.
double thrust_along_body(const AttitudeDemand& demand, const Estimate& estimate);

// The commands below have no header yet. thrust_n: collective thrust, >= 0.

// The demanded rates, or those of the attitude law; at most max_body_rate, rad/s.
plant::RatesSetpoint rates_command(const AttitudeDemand& demand, double thrust_n, const Estimate& estimate,
                                   const AttitudeController& law, double max_body_rate);

// The demanded attitude. For demanded body rates it is the present one, at which the vehicle's attitude law adds nothing.
plant::AttitudeSetpoint attitude_command(const AttitudeDemand& demand, double thrust_n,
                                         const Estimate& estimate);

// The reference of the setpoint. Without a position, and while the thrust rises at take-off, velocity and acceleration
// alone.
plant::TrajectorySetpoint trajectory_command(const ControlSetpoint& setpoint, const Estimate& estimate);

// The same command in the frame of the vehicle's own estimate: attitude, position and all horizontal vectors.
plant::VehicleCommand in_vehicle_frame(const plant::VehicleCommand& command, const EstimateSource& source);

// The command while the rotors are off or idle. At level trajectory, free fall asks for no thrust.
plant::VehicleCommand idle_command(plant::ControlLevel level, const Estimate& estimate);

}  // namespace swiftlet::control

#include "swiftlet/control/level_commands.hpp"

#include <algorithm>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

using Eigen::Vector3d;

double thrust_along_body(const AttitudeDemand& demand, const Estimate& estimate) {
  return demand.thrust_n * std::max(demand.attitude.body_z_ned.dot(body_z(estimate.q_ned_from_frd)), 0.0);
}

plant::RatesSetpoint rates_command(const AttitudeDemand& demand, double thrust_n, const Estimate& estimate,
                                   const AttitudeController& law, double max_body_rate) {
  plant::RatesSetpoint rates;
  rates.body_rates_frd =
      demand.rates_only ? demand.attitude.body_rates : law.rates(estimate.q_ned_from_frd, demand.attitude);
  const double rate = rates.body_rates_frd.norm();
  if (rate > max_body_rate) rates.body_rates_frd *= max_body_rate / rate;
  rates.thrust_n = thrust_n;
  return rates;
}

plant::AttitudeSetpoint attitude_command(const AttitudeDemand& demand, double thrust_n,
                                         const Estimate& estimate) {
  plant::AttitudeSetpoint wanted;
  wanted.q_ned_from_frd =
      demand.rates_only
          ? estimate.q_ned_from_frd
          : Eigen::Quaterniond(attitude_along(demand.attitude.body_z_ned, demand.attitude.heading));
  wanted.body_rates_frd = demand.attitude.body_rates;
  wanted.thrust_n = thrust_n;
  return wanted;
}

plant::TrajectorySetpoint trajectory_command(const ControlSetpoint& setpoint, const Estimate& estimate) {
  const Reference& reference = setpoint.reference;
  plant::TrajectorySetpoint wanted;
  wanted.yaw_rad = reference.yaw_rad;
  if (setpoint.control_mode == ControlMode::kSpoolUp) {
    wanted.acceleration_ned.z() = (1.0 - setpoint.lift_fraction) * plant::kGravity;
  } else if (setpoint.control_mode == ControlMode::kLevelDescent) {
    wanted.velocity_ned.z() = setpoint.descent_speed;
    wanted.yaw_rad = math::euler_angles(estimate.q_ned_from_frd).heading.yaw_rad;
  } else {
    wanted.position_used = setpoint.control_mode == ControlMode::kFly;
    wanted.position_ned = reference.position_ned;
    wanted.velocity_ned = reference.velocity_ned;
    wanted.acceleration_ned = reference.acceleration_ned;
    wanted.yaw_rate = reference.yaw_rate;
  }
  return wanted;
}

plant::VehicleCommand in_vehicle_frame(const plant::VehicleCommand& command, const EstimateSource& source) {
  const double turn_rad = source.heading_to_vehicle_rad();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(turn_rad, Vector3d::UnitZ()));
  plant::VehicleCommand out = command;
  if (auto* attitude = std::get_if<plant::AttitudeSetpoint>(&out))
    attitude->q_ned_from_frd = turn * attitude->q_ned_from_frd;
  if (auto* trajectory = std::get_if<plant::TrajectorySetpoint>(&out)) {
    trajectory->position_ned = source.position_in_vehicle(trajectory->position_ned);
    trajectory->velocity_ned = turn * trajectory->velocity_ned;
    trajectory->acceleration_ned = turn * trajectory->acceleration_ned;
    trajectory->yaw_rad = math::wrap_angle(trajectory->yaw_rad + turn_rad);
  }
  return out;
}

plant::VehicleCommand idle_command(plant::ControlLevel level, const Estimate& estimate) {
  const math::Heading now = math::euler_angles(estimate.q_ned_from_frd).heading;
  if (level == plant::ControlLevel::kRates) return plant::RatesSetpoint();
  if (level == plant::ControlLevel::kAttitude) {
    plant::AttitudeSetpoint upright;
    upright.q_ned_from_frd = Eigen::Quaterniond(attitude_along(Vector3d::UnitZ(), now));
    return upright;
  }
  plant::TrajectorySetpoint falling;
  falling.acceleration_ned.z() = plant::kGravity;
  falling.yaw_rad = now.yaw_rad;
  return falling;
}

}  // namespace swiftlet::control

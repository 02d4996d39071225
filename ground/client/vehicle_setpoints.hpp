// The setpoints that can be streamed to a vehicle, a struct for each kind. NED: north, east, down of the
// origin. FRD: forward, right, down of the vehicle.
#pragma once

#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/types/request.hpp"

namespace swiftlet::ground {

// The heading, for setpoints that do not command an attitude.
struct HeadingSetpoint {
  std::optional<double> yaw_rad;  // from north towards east; not given: the heading is kept
  double yaw_rate_rad_s = 0.0;    // fed forward; turns the heading if yaw_rad is not given
};

struct PositionSetpoint {
  Eigen::Vector3d position_ned_m;
  Eigen::Vector3d velocity_ned_m_s = Eigen::Vector3d::Zero();       // fed forward
  Eigen::Vector3d acceleration_ned_m_s2 = Eigen::Vector3d::Zero();  // fed forward
  HeadingSetpoint heading{};
};

struct VelocitySetpoint {
  Eigen::Vector3d velocity_ned_m_s;
  Eigen::Vector3d acceleration_ned_m_s2 = Eigen::Vector3d::Zero();  // fed forward
  HeadingSetpoint heading{};
};

struct AccelerationSetpoint {
  Eigen::Vector3d acceleration_ned_m_s2;
  HeadingSetpoint heading{};
};

// thrust_m_s2 is force over mass along -z of FRD: 9.81 m/s^2 carries the weight.
struct AttitudeSetpoint {
  Eigen::Quaterniond q_ned_from_frd;  // unit length
  double specific_thrust_m_s2 = 0.0;
  Eigen::Vector3d body_rates_frd_rad_s = Eigen::Vector3d::Zero();  // fed forward
};

struct BodyRatesSetpoint {
  Eigen::Vector3d body_rates_frd_rad_s;
  double specific_thrust_m_s2 = 0.0;
};

control::Setpoint to_setpoint(const PositionSetpoint& in);
control::Setpoint to_setpoint(const VelocitySetpoint& in);
control::Setpoint to_setpoint(const AccelerationSetpoint& in);
control::Setpoint to_setpoint(const AttitudeSetpoint& in);
control::Setpoint to_setpoint(const BodyRatesSetpoint& in);

}  // namespace swiftlet::ground

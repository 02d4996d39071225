// Position and velocity control of a flight-control firmware: P of the position, PI of the velocity, and the map from
// acceleration to attitude and thrust, as of PX4 and Crazyflie.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/vehicle_command.hpp"
#include "swiftlet/plant/simulation/firmware/gains.hpp"

namespace swiftlet::plant {

struct AttitudeAndThrust {
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  double thrust_n = 0.0;
};

class PositionLoop {
 public:
  PositionLoop(const PositionGains& gains, double mass_kg) : gains_(gains), mass_kg_(mass_kg) {}

  // dt_s > 0. The integral of the velocity stands still unless `integrate`. An acceleration of (0, 0, g) or more gives
  // no thrust.
  AttitudeAndThrust step(const TrajectorySetpoint& wanted, const Eigen::Vector3d& position_ned,
                         const Eigen::Vector3d& velocity_ned, const Eigen::Quaterniond& q_ned_from_frd,
                         double dt_s, bool integrate);
  void reset() { integral_.setZero(); }

  const Eigen::Vector3d& integral() const { return integral_; }  // m/s^2

 private:
  Eigen::Vector3d acceleration(const TrajectorySetpoint& wanted, const Eigen::Vector3d& position_ned,
                               const Eigen::Vector3d& velocity_ned, double dt_s, bool integrate);

  PositionGains gains_;
  double mass_kg_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
};

}  // namespace swiftlet::plant

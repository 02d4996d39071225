// State estimate: the IMU propagates, mocap corrects. Position, velocity, attitude, gyro and accelerometer bias.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/settings.hpp"
#include "plant/model/samples.hpp"

namespace swiftlet::control {

struct Estimate {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();            // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();            // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();          // rad/s, bias removed
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();               // rad/s
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();      // m/s^2, in FRD
};

}  // namespace swiftlet::control

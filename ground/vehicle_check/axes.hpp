// The arrangement of a sensor's axes, from its responses to known motions.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace swiftlet::ground {

constexpr double kTilt_deg = 10.0;      // limit for the floor, the IMU and the estimate of a standing vehicle
constexpr double kAlignment_deg = 5.0;  // limit between motion capture and the vehicle

// Component i of the sensor shows sign[i] times the component axis[i] of the vehicle, in FRD.
struct AxisMap {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  bool is_identity() const;
  Eigen::Matrix3d matrix() const;  // sensor from vehicle
};

// Column j: the response of the sensor to the j-th axis of the vehicle; only its direction counts. nullopt if a
// response is shorter than `least`, points along no axis, or two show the same axis.
std::optional<AxisMap> axis_map(const Eigen::Matrix3d& response, double least);

// The likely defect: "the sign of y is reversed", "x and y are exchanged"; "" for the identity.
std::string describe(const AxisMap& map);

// Between two directions.
double angle_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

// "(0.03, -0.99, 0.05)"
std::string to_string(const Eigen::Vector3d& vector, int decimals);

}  // namespace swiftlet::ground

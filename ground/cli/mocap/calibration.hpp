// How the body of a motion capture sits on its vehicle: misalignment and lever arm with their uncertainty.
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/io/mocap/room.hpp"

namespace swiftlet::ground {

// Poses of the body in NED, without lever arm and misalignment.
using BodyPoses = std::vector<mocap::NedPose>;

struct Misalignment {
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();     // as in the room file, rad
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  // standard deviation of each component, rad
};

struct LeverArm {
  Eigen::Vector3d frd = Eigen::Vector3d::Zero();        // m
  Eigen::Vector3d deviation = Eigen::Vector3d::Zero();  // standard deviation of each component, m
  double residual_m = 0.0;                              // RMS of the distance of the centre from its mean
};

// Largest scatter of a vehicle that stands, and of a lever arm that is of use.
constexpr double kRestM = 2e-3;
constexpr double kRestRad = 10e-3;
constexpr double kLargestDeviationM = 3e-3;
// Time after which an error of a hand that holds the vehicle is another one, s.
constexpr double kHandTime_s = 0.5;

// The misalignment of a vehicle that stands level with its nose to the north. seconds: how long. Throws std::runtime_error
// with a sentence if it moved.
Misalignment misalignment_of(const BodyPoses& poses, double seconds);

// The lever arm of a vehicle that was turned about its centre of mass, which stayed in place. Solves the least squares of
//   p_i + R_i l = c
// for the lever arm l and the place of the centre c, with position p_i of the body and attitude R_i of the vehicle. Throws
// std::runtime_error with a sentence if the vehicle was turned too little, or its centre moved too much, to tell.
LeverArm lever_arm_of(const BodyPoses& poses, const Misalignment& misalignment, double seconds);

// The room file's text with these values, whose keys it must have. Throws ConfigError otherwise.
std::string with_calibration(const std::string& text, const std::string& file_name,
                             const std::string& vehicle, const Misalignment& misalignment,
                             const LeverArm& lever_arm);

}  // namespace swiftlet::ground

#include "swiftlet/ground/cli/mocap/flight_calibration.hpp"

#include <algorithm>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr const char* kAxes[] = {"forward", "right", "down"};

// The components that are known well enough; the others are 0.
Vector3d told(const identification::EstimatedVector& estimate, double largest, std::array<bool, 3>& is_told) {
  Vector3d out = Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    is_told[static_cast<std::size_t>(i)] = estimate.deviation[i] <= largest;
    if (estimate.deviation[i] <= largest) out[i] = estimate.value[i];
  }
  return out;
}

std::string advice(const char* what, int axis, double deviation, const char* unit, bool by_turning) {
  return fmt::format("{} {} is known to {:.1f} {} only and stays as it was: {}", what, kAxes[axis],
                     1e3 * deviation, unit,
                     by_turning ? "turn about down, by 90 degrees and more" : "tilt, by quick legs");
}

}  // namespace

FlightCalibration calibrated(const mocap::VehicleBody& before, const identification::BodyAlignment& found) {
  FlightCalibration out;
  const Vector3d turn = told(found.misalignment, kLargestDeviationRad, out.misalignment_told);
  const Vector3d arm = told(found.lever_arm, kLargestDeviationM, out.lever_arm_told);
  for (int i = 0; i < 3; ++i) {
    if (!out.misalignment_told[static_cast<std::size_t>(i)])
      out.advice.push_back(advice("misalignment about", i, found.misalignment.deviation[i], "mrad", i != 2));
    if (!out.lever_arm_told[static_cast<std::size_t>(i)])
      out.advice.push_back(advice("lever arm", i, found.lever_arm.deviation[i], "mm", i != 2));
  }
  if (out.advice.size() == 6)
    throw std::runtime_error("the flight tells nothing about the body: " + out.advice.front());
  // With the body's attitude B and position b, and the room file's M and l, the poses were
  //   R = B M, p = b + R l; the vehicle is at R' = R dM = B M dM, p' = p + R' dl = b + R' (dM^-1 l + dl).
  const Quaterniond correction = math::rotation(turn);
  out.misalignment.vector = math::rotation_vector(math::rotation(before.misalignment) * correction);
  out.misalignment.deviation = found.misalignment.deviation;
  out.lever_arm.frd = correction.conjugate() * before.lever_arm_frd + arm;
  out.lever_arm.deviation = found.lever_arm.deviation;
  if (out.lever_arm.frd.cwiseAbs().maxCoeff() > mocap::kLongestLeverArmM)
    throw std::runtime_error(fmt::format("the lever arm is {:.2f} m long, at most {:g} m are allowed",
                                         out.lever_arm.frd.norm(), mocap::kLongestLeverArmM));
  return out;
}

}  // namespace swiftlet::ground

// What a path asks of a vehicle that is exactly on it, by the vehicle's model: how fast, how tilted, how much
// of each rotor, each at its worst with the place where that is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

enum class Demand {
  kFence,         // m beyond the fence; below 0 inside
  kSpeed,         // m/s
  kAcceleration,  // m/s^2
  kYawRate,       // rad/s
  kLift,          // m/s^2, the upward specific force; the least
  kTilt,          // rad, of the thrust from the vertical
  kThrust,        // N, of all rotors
  kRotorLeast,    // N, of the rotor that gives the least
  kRotorMost,     // N, of the rotor that gives the most
};
const char* to_string(Demand demand);
const char* unit_of(Demand demand);

// The worst of one demand along a path.
struct WorstDemand {
  Demand demand = Demand::kFence;
  double value = 0.0;
  double limit = 0.0;       // kLift and kRotorLeast: the least; of all others: the most
  std::size_t segment = 0;  // from 0
  double time_s = 0.0;      // from the path's start
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();

  bool exceeded() const;
  // "tilt is 0.713 rad, the limit is 0.600 rad: at 3.20 s, segment 4, (0.10, 0.20, -1.00) m NED"
  std::string sentence() const;
};

// All demands, in the order of the enumeration. Fence, speed, acceleration, yaw rate, lift and thrust are
// extrema of polynomials, found everywhere on the path; so is whether the tilt exceeds its limit, and where
// most. The rotors' thrusts are looked at every kRotorStep_s or finer (a path of more than an hour: at a
// million places). Drag is included, at rest in the air. Rotors hold their thrusts; that their speed takes
// time to change is not part of it. supply_voltage_v: at which the rotors must do it, above 0. At least one
// segment, each as check_segment() has it.
std::vector<WorstDemand> worst_demands(const plant::Vehicle& vehicle, const Limits& limits,
                                       double supply_voltage_v,
                                       const std::vector<PolynomialSegment>& segments);
constexpr double kRotorStep_s = 0.005;

}  // namespace swiftlet::control

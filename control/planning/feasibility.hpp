// Feasibility of a path by the vehicle's model, for a vehicle that follows it exactly: the worst value of
// speed, tilt, rotor thrust and other demands, and where on the path it occurs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

enum class Demand {
  kFence,         // m beyond the fence; below 0 inside
  kSpeed,         // m/s
  kAcceleration,  // m/s^2
  kYawRate,       // rad/s
  kLift,          // m/s^2, least upward specific force
  kTilt,          // rad, of the thrust from the vertical
  kThrust,        // N, of all rotors
  kRotorLeast,    // N, least thrust of any rotor
  kRotorMost,     // N, greatest thrust of any rotor
};
const char* to_string(Demand demand);
const char* unit_of(Demand demand);

// The worst value of one demand along a path.
struct WorstDemand {
  Demand demand = Demand::kFence;
  double value = 0.0;
  double limit = 0.0;       // kLift and kRotorLeast: minimum; all others: maximum
  std::size_t segment = 0;  // from 0
  double time_s = 0.0;      // from the path's start
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();

  bool exceeded() const;
  // "tilt is 0.713 rad, the limit is 0.600 rad: at 3.20 s, segment 4, (0.10, 0.20, -1.00) m NED"
  std::string sentence() const;
};

// The worst value of each demand, in the order of the enumeration. Fence, speed, acceleration, yaw rate,
// lift and thrust are extrema of polynomials and hold everywhere on the path; so does the decision whether
// the tilt exceeds its limit, and where most. Rotor thrusts are sampled every kRotorStep_s or finer (paths
// of more than an hour: at a million points). Drag in still air is included. Rotor thrusts are steady: the
// time that rotors take to change speed is not modelled. supply_voltage_v: voltage for the rotor limits,
// above 0. Needs at least one segment; each must pass check_segment().
std::vector<WorstDemand> worst_demands(const plant::Vehicle& vehicle, const Limits& limits,
                                       double supply_voltage_v,
                                       const std::vector<PolynomialSegment>& segments);
constexpr double kRotorStep_s = 0.005;

// Refuses a path on which a rotor would have to give more or less thrust than it can at the supply voltage: which, when and
// where. `what` names the path in the reason: "the mission". segments: as above, also none.
Outcome check_rotors(const char* what, const plant::Vehicle& vehicle, const Limits& limits,
                     double supply_voltage_v, const std::vector<PolynomialSegment>& segments);

}  // namespace swiftlet::control

// Detects parameters of a vehicle that are given in another unit than the file says, by ratios that hold for
// multirotors of any size within wide limits.
#pragma once

#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// The parameters with an implausible ratio to the others. Each message has value, ratio and limits, and names
// the unit that would explain the value if there is one. Parameters that break validate()'s ranges are left
// to it: any values are accepted, NaN included.
std::vector<Violation> implausible(const Vehicle& vehicle);

}  // namespace swiftlet::plant

// Conversion between degrees and radians.
#pragma once

#include <cmath>

namespace swiftlet::math {

constexpr double kDegPerRad = 180.0 / M_PI;
constexpr double kRadPerDeg = M_PI / 180.0;

}  // namespace swiftlet::math

// Moments of inertia that a body can have.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace swiftlet::identification {

// A flat vehicle's largest moment is nearly the sum of the others, which no body exceeds; noise alone may then
// put it beyond. Moves the diagonal of inertia, kg m^2, to the nearest that is possible, and says so. variances
// are of the moments that were identified: the others give way first, by any length; where all were, each gives
// way by its variance, within what chance gives.
std::optional<std::string> enforce_triangle_inequality(Eigen::Matrix3d& inertia,
                                                       const std::array<std::optional<double>, 3>& variances);

}  // namespace swiftlet::identification

// Moments of inertia that a body can have.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

namespace swiftlet::identification {

// A flat vehicle's largest moment is nearly the sum of the others, which no body exceeds; noise alone may then
// put it beyond. Moves the moments, kg m^2, to the nearest that are possible, by their variances, and says so;
// those of variance 0 stay. Leaves alone what is more than `deviations` standard deviations beyond: no chance.
// measured: whether all three were, for the sentence.
std::optional<std::string> keep_possible(Eigen::Vector3d& moments, const Eigen::Vector3d& variances,
                                         double deviations, bool measured);

}  // namespace swiftlet::identification

// Triangle inequality of the moments of inertia.
#pragma once

#include <array>
#include <optional>
#include <string>

#include <Eigen/Core>

namespace swiftlet::identification {

// Corrects the diagonal of an inertia, kg m^2, that violates the triangle inequality: no moment of a body
// exceeds the sum of the other two. The largest moment of a flat vehicle is nearly this sum, so that noise
// alone may cause a violation. variances: those of the identified moments, kg^2 m^4. If some moments were not
// identified, only these are corrected, by any amount. If all were identified, each is corrected in
// proportion to its variance, up to four standard deviations of the excess. Returns a sentence that describes
// the correction, or nullopt if there is none.
std::optional<std::string> enforce_triangle_inequality(Eigen::Matrix3d& inertia,
                                                       const std::array<std::optional<double>, 3>& variances);

}  // namespace swiftlet::identification

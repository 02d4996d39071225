#include "identification/possible_inertia.hpp"

#include <cmath>

#include "identification/estimate.hpp"

namespace swiftlet::identification {

std::optional<std::string> keep_possible(Eigen::Vector3d& moments, const Eigen::Vector3d& variances,
                                         double deviations, bool measured) {
  Eigen::Index largest = 0;
  moments.maxCoeff(&largest);
  const double beyond = 2.0 * moments[largest] - moments.sum();
  if (beyond <= 0.0 || beyond > deviations * std::sqrt(variances.sum())) return std::nullopt;
  for (Eigen::Index i = 0; i < 3; ++i)
    moments[i] += (i == largest ? -1.0 : 1.0) * beyond * variances[i] / variances.sum();
  return std::string("J_") + "xyz"[largest] + "xyz"[largest] + " came out " + shown(beyond) +
         " kg*m^2 above the sum of the other moments, which no body exceeds: " +
         (measured ? "the nearest that is possible, within what chance gives, is taken"
                   : "those that were not measured are moved");
}

}  // namespace swiftlet::identification

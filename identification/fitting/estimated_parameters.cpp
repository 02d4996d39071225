#include "swiftlet/identification/fitting/estimated_parameters.hpp"

#include <algorithm>
#include <cmath>

namespace swiftlet::identification {

double EstimatedParameters::standard_error(Eigen::Index i) const {
  return std::sqrt(std::max(covariance(i, i), 0.0));
}

double EstimatedParameters::correlation(Eigen::Index i, Eigen::Index j) const {
  const double scale = standard_error(i) * standard_error(j);
  return scale > 0.0 ? std::clamp(covariance(i, j) / scale, -1.0, 1.0) : 0.0;
}

}  // namespace swiftlet::identification

// Estimated parameters and their covariance.
#pragma once

#include <Eigen/Core>

namespace swiftlet::identification {

struct EstimatedParameters {
  Eigen::VectorXd parameters;
  Eigen::MatrixXd covariance;
  int degrees_of_freedom = 0;

  double standard_error(Eigen::Index i) const;
  double correlation(Eigen::Index i, Eigen::Index j) const;
};

}  // namespace swiftlet::identification

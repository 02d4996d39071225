// The inverse of an innovation's covariance, by the library's solver: Eigen's own takes ten seconds to compile.
#pragma once

#include <Eigen/Core>

#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::control {

inline Eigen::Matrix<double, 6, 6> inverse(const Eigen::Matrix<double, 6, 6>& a) {
  const Eigen::MatrixXd matrix = a;
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(6, 6);
  return math::solve(matrix, identity);
}

}  // namespace swiftlet::control

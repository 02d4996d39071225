// One block of parameters and one of residuals, handed to Ceres. For the sources of this library alone: its
// other headers name no Ceres.
#pragma once

#include <functional>

#include <Eigen/Core>
#include <ceres/ceres.h>

namespace swiftlet::identification {

struct Minimisation {
  ceres::LinearSolverType linear_solver = ceres::DENSE_QR;
  int most_iterations = 100;
  double function_tolerance = 1e-14;
  double parameter_tolerance = 1e-11;
  double gradient_tolerance = 1e-14;
  Eigen::VectorXd low;  // bounds; empty: none
  Eigen::VectorXd high;
};

// Least squares from x on, which is left at the best that was found; on_iteration may be empty. Whether it
// converged, to finite parameters.
bool minimise(ceres::CostFunction& cost, const Minimisation& settings,
              const std::function<void()>& on_iteration, Eigen::VectorXd& x);

}  // namespace swiftlet::identification

// Least squares with one parameter block and one residual block, solved by Ceres. Internal to this library:
// its other headers do not include Ceres.
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

// Minimises the cost, starting at x, and sets x to the best solution found. on_iteration may be empty.
// Returns true if the solver converged to finite parameters.
bool minimise(ceres::CostFunction& cost, const Minimisation& settings,
              const std::function<void()>& on_iteration, Eigen::VectorXd& x);

}  // namespace swiftlet::identification

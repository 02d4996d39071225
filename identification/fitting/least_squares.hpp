// Robust nonlinear least squares: the fit behind every experiment. Outliers are found, left out and listed,
// not weighted down in silence; the rest is plain least squares, so that its intervals mean what they say.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimated_parameters.hpp"

namespace swiftlet::identification {

// Residual of each observation, in units of the spread that its instruments are taken to have (a common
// factor does not matter), and, where jacobian is not null, their derivatives: one row an observation, one
// column a parameter. Both are sized when called. A residual that is not finite ends the fit.
using ResidualFunction = std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals,
                                            Eigen::MatrixXd* jacobian)>;

struct FitProblem {
  std::size_t observations = 0;
  Eigen::VectorXd start;  // of the right order of magnitude and not 0: parameters are scaled by it
  ResidualFunction residuals;
  // Observations may be wrong in what they were taken at, not only in what was read (a rotor speed counted
  // twice): the fit then starts from the best of many small subsets, where single rows cannot pull it along.
  bool bad_leverage = true;
  // Observations follow each other in time: if their residuals do too, intervals are widened by the
  // correlation.
  bool time_series = false;
  std::function<void()> on_iteration;  // may be empty; for fits that take long
};

// The covariance is heteroscedasticity-consistent (MacKinnon, White 1985, HC3): it holds also where the
// spread is not the same everywhere.
struct Fit : EstimatedParameters {
  std::vector<double> residuals;      // of all observations, as the problem defines them
  std::vector<std::size_t> outliers;  // observations left out, rising
  double sigma = 0.0;                 // standard deviation of the residuals without outliers
  double condition =
      0.0;  // of the Jacobian with columns of length 1; 1: parameters act apart, above 30: hardly
  double serial_correlation = 0.0;  // of neighbouring residuals, for time series
  bool converged = false;

  bool is_outlier(std::size_t observation) const;
};

// At least one more observation than parameters. An observation is an outlier if, judged by the fit to the
// others, it is further off than the furthest of so many normal deviates would be in 99 of 100 experiments.
Fit fit(const FitProblem& problem);

// Half the length of a 95 % interval over the standard error, by Student's distribution.
double interval_factor(int degrees_of_freedom);

}  // namespace swiftlet::identification

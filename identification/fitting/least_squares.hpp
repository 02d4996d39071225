// Robust nonlinear least squares, used by all experiments. Outliers are detected, excluded and listed. The
// remaining observations are fitted by plain least squares, so that the confidence intervals are valid.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimated_parameters.hpp"

namespace swiftlet::identification {

// Computes the residual of each observation over the assumed spread of its instruments (a common factor does
// not matter) and, if jacobian is not null, the derivatives: one row per observation, one column per
// parameter. Both have the right size when the function is called. A residual that is not finite ends the
// fit.
using ResidualFunction = std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals,
                                            Eigen::MatrixXd* jacobian)>;

struct FitProblem {
  std::size_t observations = 0;
  Eigen::VectorXd start;  // order of magnitude of the parameters, not 0; parameters are scaled by it
  ResidualFunction residuals;
  // True if the independent variable of an observation may be wrong as well (a rotor speed counted twice).
  // The fit then starts from the best of many small subsets, so that single rows cannot dominate it.
  bool bad_leverage = true;
  // True if the observations are a time series. Intervals are then widened by the serial correlation of the
  // residuals.
  bool time_series = false;
  std::function<void()> on_iteration;  // may be empty; called at each iteration, for progress
};

// Result of a fit. The covariance is heteroscedasticity-consistent (MacKinnon, White 1985, HC3): it is valid
// if the spread differs between observations.
struct Fit : EstimatedParameters {
  std::vector<double> residuals;      // of all observations, as the problem defines them
  std::vector<std::size_t> outliers;  // excluded observations, ascending
  double sigma = 0.0;                 // standard deviation of the residuals without outliers
  double condition = 0.0;             // of the Jacobian with columns of length 1; above 30: collinear
  double serial_correlation = 0.0;    // between consecutive residuals, for time series
  bool converged = false;

  bool is_outlier(std::size_t observation) const;
};

// Requires more observations than parameters. An observation is an outlier if its residual against the fit to
// the other observations exceeds the limit that all of the same number of normal deviates keep in 99 of 100
// experiments.
Fit fit(const FitProblem& problem);

// Half-width of a 95 % interval over the standard error, by Student's distribution.
double interval_factor(int degrees_of_freedom);

}  // namespace swiftlet::identification

// Least squares over time series with residuals that are correlated between samples and between series.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimated_parameters.hpp"

namespace swiftlet::identification {

// A series of residuals of one kind, such as one gyro axis.
struct Channel {
  std::size_t first = 0;  // index of its first residual
  std::size_t size = 0;
};

struct SeriesProblem {
  Eigen::VectorXd start;
  Eigen::VectorXd scale;  // expected size of the error of start; sets the steps of numerical differences
  Eigen::VectorXd low;    // lower bounds
  Eigen::VectorXd high;   // upper bounds
  std::vector<Channel> channels;      // the channels that make up the residuals, in their order
  std::vector<std::size_t> segments;  // of each residual: index of its segment of time
  std::size_t segment_count = 0;      // number of segments
  // The model has no noise model for disturbances that outlast a segment, such as gusts: standard errors are also
  // computed with correlation over eight segments (Newey, West 1987), and the larger ones are taken.
  bool disturbances_last = false;
  // Computes the residuals into a vector of the right size. All residuals of a channel have the same unit;
  // the fit weights the channels by their spread.
  std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)> residuals;
  std::function<void()> on_iteration;  // may be empty
};

// Result of a fit. The covariance is robust against correlation inside a segment of time, across all channels
// (Liang, Zeger 1986), with the correction for a small number of segments. The degrees of freedom are the
// number of segments minus the number of parameters. In directions that no residual depends on, the standard
// error is 1e4 times the parameters' scales.
struct SeriesFit : EstimatedParameters {
  Eigen::VectorXd residuals;           // in the channels' units
  std::vector<double> channel_spread;  // standard deviation of each channel's residuals
  bool converged = false;
};

SeriesFit fit_series(const SeriesProblem& problem);

}  // namespace swiftlet::identification

// Least squares over series in time, whose residuals are correlated from sample to sample and from series to
// series.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/estimated_parameters.hpp"

namespace swiftlet::identification {

// A residual series: rows of one kind, as of one axis of the gyro.
struct Channel {
  std::size_t first = 0;  // among all residuals
  std::size_t size = 0;
};

struct SeriesProblem {
  Eigen::VectorXd start;
  Eigen::VectorXd scale;  // of each parameter: by how much it may be off; steps of differences follow it
  Eigen::VectorXd low;    // bounds
  Eigen::VectorXd high;
  std::vector<Channel> channels;       // that make up the residuals, in their order
  std::vector<std::size_t> segments;  // of each residual: the segment of time that it belongs to
  std::size_t segment_count = 0;
  // Residuals of a channel in one unit; channels are weighed by their spread. Sized already.
  std::function<void(const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals)> residuals;
  std::function<void()> on_iteration;  // may be empty
};

// The covariance is robust against correlation inside a segment, between all channels (Liang, Zeger 1986),
// with the correction for few segments; the degrees of freedom are segments less parameters. What no residual
// depends on has a standard error of 1e4 of the parameters' scales.
struct SeriesFit : EstimatedParameters {
  Eigen::VectorXd residuals;           // in the channels' units
  std::vector<double> channel_spread;  // standard deviation of each channel's residuals
  bool converged = false;
};

SeriesFit fit_series(const SeriesProblem& problem);

}  // namespace swiftlet::identification

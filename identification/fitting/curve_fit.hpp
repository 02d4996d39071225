// Fit of a curve y = f(x; p) to readings of both: what the static experiments share.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/curve_distance.hpp"
#include "swiftlet/identification/fitting/least_squares.hpp"

namespace swiftlet::identification {

constexpr int kMostCurveParameters = 5;
using Gradient = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostCurveParameters, 1>;

// f for a row's settings, at x; fills the derivatives by the parameters, sized already.
using Curve = std::function<CurveValue(std::size_t row, double x, const Eigen::VectorXd& parameters,
                                       Gradient& by_parameters)>;

// Spread of the instruments. Only the ratio matters: how far off they are is found from the data.
struct Readings {
  const std::vector<double>& x;
  const std::vector<double>& y;
  double x_spread = 0.0;
  double y_spread = 1.0;
};

Fit fit_curve(const Readings& readings, const Eigen::VectorXd& start, const Curve& curve);

// f at the x as read, for each row.
std::vector<double> predicted(const Readings& readings, const Eigen::VectorXd& parameters,
                              const Curve& curve);

// Of a fit whose last parameter is a term that the model leaves out: whether the data ask for it, beyond what
// chance gives in one of 10,000 experiments, and beyond what rounding gives: a millionth of full_scale, the
// term's size were it alone.
bool asks_for_last(const Fit& fit, double full_scale);

}  // namespace swiftlet::identification

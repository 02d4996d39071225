// Fit of a curve y = f(x; p) to readings of x and y, as the static experiments use it.
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

// f at x for the settings of a row. Fills by_parameters, which has the right size, with the derivatives by
// the parameters.
using Curve = std::function<CurveValue(std::size_t row, double x, const Eigen::VectorXd& parameters,
                                       Gradient& by_parameters)>;

// Readings and the spreads of their instruments. Only the ratio of the spreads matters: the fit estimates
// their size from the data.
struct Readings {
  const std::vector<double>& x;
  const std::vector<double>& y;
  double x_spread = 0.0;
  double y_spread = 1.0;
};

Fit fit_curve(const Readings& readings, const Eigen::VectorXd& start, const Curve& curve);

// f at the measured x of each row.
std::vector<double> predicted(const Readings& readings, const Eigen::VectorXd& parameters,
                              const Curve& curve);

// For a fit whose last parameter is the coefficient of a term that the model omits: true if the term is
// significant at a level of 1e-4 and exceeds rounding errors, |coefficient| >= 1e-6 * full_scale. full_scale:
// coefficient with which the term alone would give the full reading.
bool asks_for_last(const Fit& fit, double full_scale);

}  // namespace swiftlet::identification

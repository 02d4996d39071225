#include "swiftlet/identification/fitting/curve_fit.hpp"

#include <cmath>

#include <boost/math/distributions/students_t.hpp>

namespace swiftlet::identification {

Fit fit_curve(const Readings& readings, const Eigen::VectorXd& start, const Curve& curve) {
  FitProblem problem;
  problem.observations = readings.y.size();
  problem.start = start;
  problem.residuals = [&](const Eigen::VectorXd& parameters, Eigen::VectorXd& residuals,
                          Eigen::MatrixXd* jacobian) {
    Gradient by_parameters(parameters.size());
    for (std::size_t row = 0; row < readings.y.size(); ++row) {
      const auto at_x = [&](double x) { return curve(row, x, parameters, by_parameters); };
      const CurveDistance found =
          curve_distance(at_x, readings.x[row], readings.y[row], readings.x_spread, readings.y_spread);
      const auto i = static_cast<Eigen::Index>(row);
      residuals[i] = found.distance;
      if (jacobian == nullptr) continue;
      at_x(found.x);
      jacobian->row(i) = -by_parameters.transpose() / found.spread;
    }
  };
  return fit(problem);
}

std::vector<double> predicted(const Readings& readings, const Eigen::VectorXd& parameters,
                              const Curve& curve) {
  std::vector<double> out;
  out.reserve(readings.x.size());
  Gradient by_parameters(parameters.size());
  for (std::size_t row = 0; row < readings.x.size(); ++row)
    out.push_back(curve(row, readings.x[row], parameters, by_parameters).y);
  return out;
}

bool asks_for_last(const Fit& fit, double full_scale) {
  constexpr double kChance = 1e-4;
  constexpr double kRounding = 1e-6;
  const Eigen::Index last = fit.parameters.size() - 1;
  if (std::abs(fit.parameters[last]) < kRounding * std::abs(full_scale)) return false;
  const boost::math::students_t distribution(fit.degrees_of_freedom);
  const double limit = boost::math::quantile(boost::math::complement(distribution, 0.5 * kChance));
  return std::abs(fit.parameters[last]) > limit * fit.standard_error(last);
}

}  // namespace swiftlet::identification

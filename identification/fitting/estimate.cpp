#include "swiftlet/identification/fitting/estimate.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

namespace swiftlet::identification {

namespace {

constexpr double kIllConditioned = 30.0;  // Belsley, Kuh, Welsch 1980: collinearity is harmful above
constexpr double kManyOutliers = 0.2;     // fraction of the rows

void warn_of_collinearity(const Fit& fit, Experiment& experiment) {
  const auto count = static_cast<Eigen::Index>(experiment.estimates.size());
  if (count < 2 || fit.condition < kIllConditioned) return;
  Eigen::Index first = 0;
  Eigen::Index second = 1;
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = i + 1; j < count; ++j) {
      if (std::abs(fit.correlation(i, j)) > std::abs(fit.correlation(first, second))) {
        first = i;
        second = j;
      }
    }
  }
  const auto symbol = [&](Eigen::Index i) {
    return experiment.estimates[static_cast<std::size_t>(i)].symbol;
  };
  experiment.warnings.push_back("these data barely separate " + symbol(first) + " and " + symbol(second) +
                                ": correlation " + format_number(fit.correlation(first, second)) +
                                ", condition number " + format_number(fit.condition) + ", should be below " +
                                format_number(kIllConditioned) + "; readings over a wider range are needed");
}

void warn_of_wide_intervals(Experiment& experiment) {
  for (const ParameterEstimate& estimate : experiment.estimates) {
    if (std::abs(estimate.value) > estimate.half_width) continue;
    experiment.warnings.push_back(estimate.symbol + " is " + format_number(estimate.value) + " +- " +
                                  format_number(estimate.half_width) + " " + estimate.unit +
                                  ": its 95 % interval contains 0");
  }
}

double r_squared(const Experiment& experiment) {
  double mean = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < experiment.measured.size(); ++i) {
    if (experiment.is_outlier(i)) continue;
    mean += experiment.measured[i];
    count += 1.0;
  }
  mean /= count;
  double rest = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < experiment.measured.size(); ++i) {
    if (experiment.is_outlier(i)) continue;
    rest += std::pow(experiment.measured[i] - experiment.predicted[i], 2);
    all += std::pow(experiment.measured[i] - mean, 2);
  }
  return all > 0.0 ? 1.0 - rest / all : 0.0;
}

double residual_sd(const Experiment& experiment, int degrees_of_freedom) {
  double sum = 0.0;
  for (std::size_t i = 0; i < experiment.measured.size(); ++i) {
    if (!experiment.is_outlier(i)) sum += std::pow(experiment.measured[i] - experiment.predicted[i], 2);
  }
  return std::sqrt(sum / degrees_of_freedom);
}

}  // namespace

bool Experiment::is_outlier(std::size_t row) const {
  return std::binary_search(outliers.begin(), outliers.end(), row);
}

const ParameterEstimate& Experiment::estimate(const std::string& parameter) const {
  for (const ParameterEstimate& candidate : estimates) {
    if (candidate.parameter == parameter) return candidate;
  }
  throw std::out_of_range(parameter + " was not estimated");
}

Experiment conclude(const Fit& fit, const std::vector<ParameterName>& names, std::vector<double> measured,
                    std::vector<double> predicted, const std::string& residual_unit) {
  Experiment out;
  const double factor = interval_factor(fit.degrees_of_freedom);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double error = fit.standard_error(at);
    out.estimates.push_back(
        {names[i].parameter, names[i].symbol, names[i].unit, fit.parameters[at], error, factor * error});
  }
  out.covariance = fit.covariance;
  out.measured = std::move(measured);
  out.predicted = std::move(predicted);
  out.outliers = fit.outliers;
  out.residual_unit = residual_unit;
  out.r_squared = r_squared(out);
  out.residual_sd = residual_sd(out, fit.degrees_of_freedom);
  if (!fit.converged) out.warnings.emplace_back("the fit did not converge; do not trust its numbers");
  const auto rows = static_cast<double>(out.measured.size());
  if (static_cast<double>(out.outliers.size()) > kManyOutliers * rows) {
    out.warnings.push_back(
        std::to_string(out.outliers.size()) + " of " + std::to_string(out.measured.size()) +
        " rows are outliers: the model does not describe these data, or they mix two set-ups");
  }
  warn_of_collinearity(fit, out);
  warn_of_wide_intervals(out);
  return out;
}

std::string format_number(double number) { return fmt::format("{:.4g}", number); }

}  // namespace swiftlet::identification

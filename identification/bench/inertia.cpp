#include "swiftlet/identification/bench/inertia.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/least_squares.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastInertiaRows = 4;
constexpr double kLeastLength = 0.005;  // m
constexpr double kMostLength = 20.0;    // m
constexpr double kSwingShare = 0.1;     // J over m arm^2; below it the error of the arm hides J

// period^2 = slope J + constant for each row.
struct PeriodLaw {
  std::vector<double> slope;
  std::vector<double> constant;
};

Experiment identify(const PeriodLaw& law, const std::vector<double>& periods, const InertiaTarget& target) {
  const auto square = [&](std::size_t row, double inertia) {
    return std::max(law.slope[row] * inertia + law.constant[row], 1e-12);
  };
  FitProblem problem;
  problem.observations = periods.size();
  std::vector<double> single;
  for (std::size_t i = 0; i < periods.size(); ++i)
    single.push_back((periods[i] * periods[i] - law.constant[i]) / law.slope[i]);
  const double start = median(single);
  if (!(start > 0.0)) {
    throw BadData("period: leads to " + std::string(target.symbol) + " = " + format_number(start) +
                  " kg*m^2, must be above 0: a point mass would swing slower; are the units right?");
  }
  problem.start = Eigen::VectorXd::Constant(1, start);
  problem.residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    for (std::size_t row = 0; row < periods.size(); ++row) {
      const auto i = static_cast<Eigen::Index>(row);
      const double period = std::sqrt(square(row, p[0]));
      residuals[i] = periods[row] - period;
      if (jacobian != nullptr) (*jacobian)(i, 0) = -0.5 * law.slope[row] / period;
    }
  };
  const Fit found = fit(problem);
  std::vector<double> predicted;
  for (std::size_t row = 0; row < periods.size(); ++row)
    predicted.push_back(std::sqrt(square(row, found.parameters[0])));
  Experiment out =
      conclude(found, {{target.parameter, target.symbol, "kg*m^2"}}, periods, std::move(predicted), "s");

  ParameterEstimate& inertia = out.estimates.front();
  inertia.standard_error = std::hypot(inertia.standard_error, inertia.value * target.mass_error);
  inertia.half_width = interval_factor(found.degrees_of_freedom) * inertia.standard_error;
  out.covariance(0, 0) = inertia.standard_error * inertia.standard_error;
  require_gyration("period", inertia, target.mass_kg, target.size_m);
  return out;
}

}  // namespace

Experiment identify_inertia(const BifilarData& data, const InertiaTarget& target) {
  const Column length{"length", "m", data.length_m};
  const Column separation{"separation", "m", data.separation_m};
  const Column period{"period", "s", data.period_s};
  require_rows({length, separation, period}, kLeastInertiaRows);
  require_each_between(length, kLeastLength, kMostLength, "no bench uses shorter or longer strings");
  require_each_between(separation, kLeastLength, kMostLength, "no bench hangs strings closer or wider apart");
  require_median_between(period, 0.02, 60.0, "no bench swings faster or slower");
  PeriodLaw law;
  for (std::size_t i = 0; i < data.period_s.size(); ++i) {
    law.slope.push_back(16.0 * M_PI * M_PI * data.length_m[i] /
                        (target.mass_kg * plant::kGravity * data.separation_m[i] * data.separation_m[i]));
    law.constant.push_back(0.0);
  }
  return identify(law, data.period_s, target);
}

Experiment identify_inertia(const SwingData& data, const InertiaTarget& target) {
  const Column arm{"arm", "m", data.arm_m};
  const Column period{"period", "s", data.period_s};
  require_rows({arm, period}, kLeastInertiaRows);
  require_each_between(arm, kLeastLength, kMostLength, "no bench uses a shorter or longer arm");
  require_median_between(period, 0.02, 60.0, "no bench swings faster or slower");
  PeriodLaw law;
  for (std::size_t i = 0; i < data.period_s.size(); ++i) {
    law.slope.push_back(4.0 * M_PI * M_PI / (target.mass_kg * plant::kGravity * data.arm_m[i]));
    law.constant.push_back(4.0 * M_PI * M_PI * data.arm_m[i] / plant::kGravity);
  }
  Experiment out = identify(law, data.period_s, target);
  const double shortest = *std::min_element(data.arm_m.begin(), data.arm_m.end());
  const double share = out.estimates.front().value / (target.mass_kg * shortest * shortest);
  if (share < kSwingShare) {
    out.warnings.push_back(
        out.estimates.front().symbol + " is only " + format_number(share) +
        " of m arm^2 of the shortest arm, should be at least " + format_number(kSwingShare) +
        ": a small error of the arm hides it; swing closer to the centre of mass or use two strings");
  }
  return out;
}

}  // namespace swiftlet::identification

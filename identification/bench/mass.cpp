#include "swiftlet/identification/bench/mass.hpp"

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/least_squares.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastMassRows = 3;
constexpr double kLeastMass = 1e-3;  // kg
constexpr double kMostMass = 1e3;

}  // namespace

Experiment identify_mass(const std::vector<double>& mass_kg) {
  const Column mass{"mass", "kg", mass_kg};
  require_rows({mass}, kLeastMassRows);
  require_median_between(mass, kLeastMass, kMostMass, "no multirotor is lighter or heavier");
  FitProblem problem;
  problem.observations = mass_kg.size();
  problem.start = Eigen::VectorXd::Constant(1, median(mass_kg));
  problem.residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    for (std::size_t row = 0; row < mass_kg.size(); ++row)
      residuals[static_cast<Eigen::Index>(row)] = mass_kg[row] - p[0];
    if (jacobian != nullptr) jacobian->setConstant(-1.0);
  };
  const Fit found = fit(problem);
  Experiment out = conclude(found, {{"mass", "m", "kg"}}, mass_kg,
                            std::vector<double>(mass_kg.size(), found.parameters[0]), "kg");
  if (out.residual_sd == 0.0) {
    out.warnings.emplace_back(
        "all readings are the same: the balance's resolution hides their spread, and the interval is too "
        "narrow");
  }
  return out;
}

}  // namespace swiftlet::identification

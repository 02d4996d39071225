#include "swiftlet/identification/fitting/least_squares.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <Eigen/QR>
#include <boost/math/distributions/students_t.hpp>
#include <ceres/ceres.h>

#include "swiftlet/identification/fitting/minimise.hpp"
#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::identification {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSubsets = 40;           // with half the rows bad and two parameters, one is good almost surely
constexpr int kSubsetSteps = 4;        // Gauss-Newton steps on a subset
constexpr int kReweightings = 15;      // with Tukey's biweight
constexpr double kTukey = 4.685;       // 95 % as efficient as least squares on normal deviates
constexpr double kNormalMad = 1.4826;  // standard deviation of normal deviates over their median magnitude
constexpr double kFirstCut = 4.0;      // in robust standard deviations
constexpr double kFalseOutliers = 0.01;  // fraction of experiments in which a good row becomes an outlier
constexpr int kMostScreenings = 20;
constexpr double kLeastSpread = 1e-12;  // of residuals; for data without noise

double magnitude_quantile(VectorXd residuals, double share) {
  residuals = residuals.cwiseAbs();
  const auto at = static_cast<Index>(share * static_cast<double>(residuals.size() - 1));
  std::nth_element(residuals.data(), residuals.data() + at, residuals.data() + residuals.size());
  return residuals[at];
}

// The problem with parameters scaled to the order of 1.
class ScaledProblem {
 public:
  explicit ScaledProblem(const FitProblem& problem)
      : problem_(problem),
        scale_(problem.start.cwiseAbs()),
        residuals_(static_cast<Index>(problem.observations)),
        jacobian_(residuals_.size(), scale_.size()) {}

  Index rows() const { return residuals_.size(); }
  Index columns() const { return scale_.size(); }
  VectorXd start() const { return problem_.start.cwiseQuotient(scale_); }
  VectorXd unscaled(const VectorXd& x) const { return x.cwiseProduct(scale_); }
  const VectorXd& scale() const { return scale_; }
  const FitProblem& problem() const { return problem_; }

  const VectorXd& residuals(const VectorXd& x) {
    problem_.residuals(unscaled(x), residuals_, nullptr);
    return residuals_;
  }
  const VectorXd& linearise(const VectorXd& x) {
    problem_.residuals(unscaled(x), residuals_, &jacobian_);
    jacobian_ = jacobian_ * scale_.asDiagonal();
    return residuals_;
  }
  const MatrixXd& jacobian() const { return jacobian_; }  // of the last call of linearise()

 private:
  const FitProblem& problem_;
  VectorXd scale_;
  VectorXd residuals_;
  MatrixXd jacobian_;
};

class WeightedCost final : public ceres::CostFunction {
 public:
  WeightedCost(ScaledProblem& problem, const VectorXd& root_weights)
      : problem_(problem), root_weights_(root_weights) {
    set_num_residuals(static_cast<int>(problem.rows()));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.columns()));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const VectorXd> x(parameters[0], problem_.columns());
    Eigen::Map<VectorXd> out(residuals, problem_.rows());
    const bool with_jacobian = jacobians != nullptr && jacobians[0] != nullptr;
    out = with_jacobian ? problem_.linearise(x) : problem_.residuals(x);
    out.array() *= root_weights_.array();
    if (with_jacobian) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows(
          jacobians[0], problem_.rows(), problem_.columns());
      rows = root_weights_.asDiagonal() * problem_.jacobian();
    }
    return out.allFinite();
  }

 private:
  ScaledProblem& problem_;
  const VectorXd& root_weights_;
};

// Weighted least squares, starting at x. Returns true if it converged.
bool minimise(ScaledProblem& problem, const VectorXd& root_weights, VectorXd& x) {
  WeightedCost cost(problem, root_weights);
  return identification::minimise(cost, Minimisation(), problem.problem().on_iteration, x);
}

// Gauss-Newton on as many rows as there are parameters, beginning at the start. Returns false if it diverges.
bool solve_subset(ScaledProblem& problem, const std::vector<Index>& rows, VectorXd& x) {
  const auto count = static_cast<Index>(rows.size());
  MatrixXd jacobian(count, problem.columns());
  VectorXd residuals(count);
  x = problem.start();
  for (int step = 0; step < kSubsetSteps; ++step) {
    const VectorXd& all = problem.linearise(x);
    for (Index i = 0; i < count; ++i) {
      residuals[i] = all[rows[static_cast<std::size_t>(i)]];
      jacobian.row(i) = problem.jacobian().row(rows[static_cast<std::size_t>(i)]);
    }
    if (!residuals.allFinite() || !jacobian.allFinite()) return false;
    x -= math::least_squares(jacobian, residuals);
    if (!x.allFinite()) return false;
  }
  return problem.residuals(x).allFinite();
}

// Least median of squares (Rousseeuw 1984): of the start and the solutions of random subsets, the one with
// the smallest median magnitude of all residuals.
VectorXd best_start(ScaledProblem& problem) {
  VectorXd best = problem.start();
  double least = magnitude_quantile(problem.residuals(best), 0.5);
  std::mt19937_64 random(20140527);
  std::vector<Index> all(static_cast<std::size_t>(problem.rows()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<Index>(i);
  const auto wanted = static_cast<std::size_t>(problem.columns());
  VectorXd x;
  for (int subset = 0; subset < kSubsets; ++subset) {
    for (std::size_t i = 0; i < wanted; ++i) std::swap(all[i], all[i + random() % (all.size() - i)]);
    const std::vector<Index> rows(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(wanted));
    if (!solve_subset(problem, rows, x)) continue;
    const double median = magnitude_quantile(problem.residuals(x), 0.5);
    if (median < least) {
      least = median;
      best = x;
    }
  }
  return best;
}

double robust_spread(const VectorXd& residuals, Index parameters) {
  const auto n = static_cast<double>(residuals.size());
  const double correction = std::sqrt(n / (n - static_cast<double>(parameters)));
  return std::max(kNormalMad * correction * magnitude_quantile(residuals, 0.5), kLeastSpread);
}

// Iteratively reweighted least squares with Tukey's biweight. Sets x to the robust estimate.
void reweight(ScaledProblem& problem, VectorXd& x) {
  VectorXd root_weights(problem.rows());
  for (int round = 0; round < kReweightings; ++round) {
    const VectorXd& residuals = problem.linearise(x);
    const double limit = kTukey * robust_spread(residuals, problem.columns());
    for (Index i = 0; i < problem.rows(); ++i) {
      const double ratio = residuals[i] / limit;
      root_weights[i] = std::abs(ratio) < 1.0 ? 1.0 - ratio * ratio : 0.0;
    }
    const VectorXd step = math::least_squares(root_weights.asDiagonal() * problem.jacobian(),
                                              root_weights.asDiagonal() * residuals);
    if (!step.allFinite()) return;
    const VectorXd before = x;
    x -= step;
    if (!problem.residuals(x).allFinite()) {
      x = before;
      return;
    }
    if (step.norm() < 1e-8 * x.norm()) return;
  }
}

double student_quantile(double upper_tail, int degrees_of_freedom) {
  const boost::math::students_t distribution(degrees_of_freedom);
  return boost::math::quantile(boost::math::complement(distribution, upper_tail));
}

VectorXd weights_of(const std::vector<bool>& inside) {
  VectorXd weights(static_cast<Index>(inside.size()));
  for (std::size_t i = 0; i < inside.size(); ++i) weights[static_cast<Index>(i)] = inside[i] ? 1.0 : 0.0;
  return weights;
}

MatrixXd inverse_information(const MatrixXd& jacobian, const VectorXd& weights) {
  const MatrixXd information = jacobian.transpose() * weights.asDiagonal() * jacobian;
  return information.completeOrthogonalDecomposition().pseudoInverse();
}

// Statistics of the fit to the rows that are not outliers.
struct Spread {
  double sigma = 0.0;
  int degrees_of_freedom = 0;
  MatrixXd inverse;    // of J^T J, scaled parameters
  VectorXd leverages;  // J_i (J^T J)^-1 J_i^T for every row i, outliers included
};

Spread spread_of(const VectorXd& residuals, const MatrixXd& jacobian, const VectorXd& weights) {
  Spread out;
  out.degrees_of_freedom = std::max(1, static_cast<int>(std::lround(weights.sum()) - jacobian.cols()));
  out.sigma = std::sqrt((weights.array() * residuals.array().square()).sum() / out.degrees_of_freedom);
  out.inverse = inverse_information(jacobian, weights);
  out.leverages = (jacobian * out.inverse).cwiseProduct(jacobian).rowwise().sum();
  return out;
}

// Tests each row against the fit to the other rows (externally studentised residuals). Returns true for each
// row that is not an outlier.
std::vector<bool> screened(const VectorXd& residuals, const Spread& spread, const std::vector<bool>& inside) {
  const double tail = 0.5 * kFalseOutliers / static_cast<double>(inside.size());
  const double dof = spread.degrees_of_freedom;
  std::vector<bool> accepted(inside.size());
  for (std::size_t i = 0; i < inside.size(); ++i) {
    const auto row = static_cast<Index>(i);
    const double leverage = spread.leverages[row];
    if (!inside[i]) {
      const double expected = spread.sigma * std::sqrt(1.0 + leverage);
      accepted[i] = std::abs(residuals[row]) <=
                    student_quantile(tail, spread.degrees_of_freedom) * expected + kLeastSpread;
      continue;
    }
    const double rest = std::max(1.0 - leverage, 1e-9);
    const double without = (dof * spread.sigma * spread.sigma - residuals[row] * residuals[row] / rest) /
                           std::max(dof - 1.0, 1.0);
    const double expected = std::sqrt(std::max(without, 0.0) * rest);
    const double limit = student_quantile(tail, std::max(1, spread.degrees_of_freedom - 1));
    accepted[i] = std::abs(residuals[row]) <= limit * expected + kLeastSpread;
  }
  return accepted;
}

double serial_correlation(const VectorXd& residuals, const std::vector<bool>& inside) {
  double product = 0.0;
  double square = 0.0;
  double before = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = 0; i < inside.size(); ++i) {
    if (!inside[i]) continue;
    const double now = residuals[static_cast<Index>(i)];
    if (std::isfinite(before)) product += before * now;
    square += now * now;
    before = now;
  }
  return square > 0.0 ? product / square : 0.0;
}

// Factor by which the variance of a mean of correlated deviates exceeds that of independent ones. It is 1 for
// a correlation that is not significant.
double variance_inflation(double correlation, Index count) {
  if (correlation < 3.0 / std::sqrt(static_cast<double>(count))) return 1.0;
  const double bounded = std::min(correlation, 0.999);
  return (1.0 + bounded) / (1.0 - bounded);
}

MatrixXd consistent_covariance(const VectorXd& residuals, const MatrixXd& jacobian, const VectorXd& weights,
                               const Spread& spread) {
  VectorXd squares(residuals.size());
  for (Index i = 0; i < residuals.size(); ++i) {
    const double rest = std::max(1.0 - spread.leverages[i], 1e-9);
    squares[i] = weights[i] * residuals[i] * residuals[i] / (rest * rest);
  }
  return spread.inverse * (jacobian.transpose() * squares.asDiagonal() * jacobian) * spread.inverse;
}

double condition_of(MatrixXd jacobian, const VectorXd& weights) {
  jacobian = weights.asDiagonal() * jacobian;
  for (Index i = 0; i < jacobian.cols(); ++i) {
    const double length = jacobian.col(i).norm();
    if (!(length > 0.0)) return std::numeric_limits<double>::infinity();
    jacobian.col(i) /= length;
  }
  const VectorXd values = math::singular_values(jacobian);
  return values[0] / values[values.size() - 1];
}

}  // namespace

bool Fit::is_outlier(std::size_t observation) const {
  return std::binary_search(outliers.begin(), outliers.end(), observation);
}

double interval_factor(int degrees_of_freedom) { return student_quantile(0.025, degrees_of_freedom); }

Fit fit(const FitProblem& given) {
  ScaledProblem problem(given);
  VectorXd x = problem.start();
  if (given.bad_leverage) {
    x = best_start(problem);
  } else {
    minimise(problem, VectorXd::Ones(problem.rows()), x);
  }
  reweight(problem, x);

  std::vector<bool> inside(given.observations);
  {
    const VectorXd& residuals = problem.residuals(x);
    const double limit = kFirstCut * robust_spread(residuals, problem.columns());
    for (std::size_t i = 0; i < inside.size(); ++i)
      inside[i] = std::abs(residuals[static_cast<Index>(i)]) <= limit;
  }
  const auto enough = [&](const std::vector<bool>& rows) {
    return std::count(rows.begin(), rows.end(), true) > problem.columns();
  };
  if (!enough(inside)) inside.assign(inside.size(), true);

  Fit out;
  VectorXd weights;
  VectorXd residuals;
  Spread spread;
  for (int round = 0; round < kMostScreenings; ++round) {
    weights = weights_of(inside);
    out.converged = minimise(problem, weights, x);
    residuals = problem.linearise(x);
    spread = spread_of(residuals, problem.jacobian(), weights);
    const std::vector<bool> accepted = screened(residuals, spread, inside);
    if (accepted == inside || !enough(accepted)) break;
    inside = accepted;
  }

  out.parameters = problem.unscaled(x);
  out.serial_correlation = given.time_series ? serial_correlation(residuals, inside) : 0.0;
  const double inflation =
      given.time_series ? variance_inflation(out.serial_correlation, problem.rows()) : 1.0;
  out.covariance = inflation * (problem.scale().asDiagonal() *
                                consistent_covariance(residuals, problem.jacobian(), weights, spread) *
                                problem.scale().asDiagonal());
  out.residuals.assign(residuals.data(), residuals.data() + residuals.size());
  for (std::size_t i = 0; i < given.observations; ++i) {
    if (weights[static_cast<Index>(i)] == 0.0) out.outliers.push_back(i);
  }
  out.degrees_of_freedom = spread.degrees_of_freedom;
  out.sigma = spread.sigma;
  out.condition = condition_of(problem.jacobian(), weights);
  return out;
}

}  // namespace swiftlet::identification

#include "swiftlet/identification/fitting/series_fit.hpp"

#include <algorithm>
#include <cmath>

#include <ceres/ceres.h>

#include "swiftlet/identification/fitting/minimise.hpp"
#include "swiftlet/math/linear_algebra.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kStep = 1e-3;        // of central differences, over a parameter's scale
constexpr int kMostReweightings = 4;  // fits, each with the channel spreads of the one before
constexpr double kSettled = 0.01;     // relative change of the spreads that ends the reweighting
constexpr double kLeastSeriesSpread = 1e-9;
constexpr double kUnseen = 1e-14;         // eigenvalue of the normal matrix over the largest one
constexpr double kUnseenDeviation = 1e4;  // standard deviation in unobservable directions, in scales

constexpr Index kLastingSegments = 8;  // neighbouring segments whose scores may be correlated

// The problem with residuals divided by the spreads of their channels and parameters divided by their scales.
class WeightedProblem final : public ceres::CostFunction {
 public:
  explicit WeightedProblem(const SeriesProblem& problem)
      : problem_(problem),
        rows_(static_cast<Index>(problem.segments.size())),
        spread_(VectorXd::Ones(static_cast<Index>(problem.channels.size()))),
        above_(rows_),
        below_(rows_) {
    set_num_residuals(static_cast<int>(rows_));
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.start.size()));
  }

  bool Evaluate(const double* const* parameters, double* residuals, double** jacobians) const override {
    const Eigen::Map<const VectorXd> x(parameters[0], problem_.start.size());
    Eigen::Map<VectorXd> out(residuals, rows_);
    out = residuals_at(x);
    if (jacobians != nullptr && jacobians[0] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> rows(
          jacobians[0], rows_, x.size());
      rows = jacobian_at(x);
    }
    return out.allFinite();
  }

  VectorXd residuals_at(const VectorXd& x) const {
    VectorXd out(rows_);
    problem_.residuals(x.cwiseProduct(problem_.scale), out);
    for_each_channel(
        [&](Index channel, Index first, Index size) { out.segment(first, size) /= spread_[channel]; });
    return out;
  }

  MatrixXd jacobian_at(const VectorXd& x) const {
    MatrixXd out(rows_, x.size());
    VectorXd at = x;
    for (Index i = 0; i < x.size(); ++i) {
      const double high = std::min(x[i] + kStep, problem_.high[i] / problem_.scale[i]);
      const double low = std::max(x[i] - kStep, problem_.low[i] / problem_.scale[i]);
      at[i] = high;
      above_ = residuals_at(at);
      at[i] = low;
      below_ = residuals_at(at);
      at[i] = x[i];
      out.col(i) = (above_ - below_) / (high - low);
    }
    return out;
  }

  // Sets the channel spreads from unweighted residuals. Returns the largest relative change.
  double update_spreads(const VectorXd& residuals) {
    double change = 0.0;
    for_each_channel([&](Index channel, Index first, Index size) {
      const double square = residuals.segment(first, size).squaredNorm();
      const double spread = std::max(std::sqrt(square / static_cast<double>(size)), kLeastSeriesSpread);
      change = std::max(change, std::abs(spread / spread_[channel] - 1.0));
      spread_[channel] = spread;
    });
    return change;
  }

  const VectorXd& spread() const { return spread_; }

 private:
  template <typename Work>
  void for_each_channel(const Work& work) const {
    for (std::size_t i = 0; i < problem_.channels.size(); ++i) {
      const Channel& channel = problem_.channels[i];
      if (channel.size > 0)
        work(static_cast<Index>(i), static_cast<Index>(channel.first), static_cast<Index>(channel.size));
    }
  }

  const SeriesProblem& problem_;
  Index rows_;
  VectorXd spread_;
  mutable VectorXd above_;
  mutable VectorXd below_;
};

// Inverse of the normal matrix, in scaled parameters.
struct Information {
  MatrixXd inverse;  // in the directions in which residuals change
  MatrixXd unseen;   // covariance in the other, unobservable directions
};

Information inverted(const MatrixXd& normal) {
  const auto [values, vectors] = math::symmetric_eigen(normal);
  const double least = kUnseen * std::max(values.maxCoeff(), 0.0);
  Information out{MatrixXd::Zero(normal.rows(), normal.cols()), MatrixXd::Zero(normal.rows(), normal.cols())};
  for (Index i = 0; i < values.size(); ++i) {
    const auto direction = vectors.col(i);
    if (values[i] > least) {
      out.inverse += direction * direction.transpose() / values[i];
    } else {
      out.unseen += kUnseenDeviation * kUnseenDeviation * direction * direction.transpose();
    }
  }
  return out;
}

// Sum of the products of scores up to kLastingSegments apart, one score a row (Newey, West 1987).
MatrixXd lasting_products(const MatrixXd& scores) {
  MatrixXd out = scores.transpose() * scores;
  for (Index lag = 1; lag <= std::min(kLastingSegments, scores.rows() - 1); ++lag) {
    const Index pairs = scores.rows() - lag;
    const MatrixXd products = scores.topRows(pairs).transpose() * scores.bottomRows(pairs);
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(kLastingSegments + 1);
    out += weight * (products + products.transpose());
  }
  return out;
}

// How much wider the standard errors are by the second covariance than by the first, at least 1.
VectorXd widening(const MatrixXd& first, const MatrixXd& second) {
  VectorXd out = VectorXd::Ones(first.rows());
  for (Index i = 0; i < out.size(); ++i) {
    if (second(i, i) > first(i, i)) out[i] = std::sqrt(second(i, i) / first(i, i));
  }
  return out;
}

Minimisation minimisation_of(const SeriesProblem& problem) {
  Minimisation settings;
  settings.linear_solver = ceres::DENSE_NORMAL_CHOLESKY;
  settings.most_iterations = 50;
  settings.function_tolerance = 1e-7;
  settings.parameter_tolerance = 1e-5;
  settings.gradient_tolerance = 1e-10;
  settings.low = problem.low.cwiseQuotient(problem.scale);
  settings.high = problem.high.cwiseQuotient(problem.scale);
  return settings;
}

}  // namespace

SeriesFit fit_series(const SeriesProblem& problem) {
  WeightedProblem cost(problem);
  VectorXd x = problem.start.cwiseQuotient(problem.scale);
  SeriesFit out;
  out.residuals.resize(static_cast<Index>(problem.segments.size()));
  problem.residuals(problem.start, out.residuals);
  cost.update_spreads(out.residuals);
  for (int round = 0; round < kMostReweightings; ++round) {
    out.converged = minimise(cost, minimisation_of(problem), problem.on_iteration, x);
    problem.residuals(x.cwiseProduct(problem.scale), out.residuals);
    if (cost.update_spreads(out.residuals) < kSettled) break;
  }

  const VectorXd residuals = cost.residuals_at(x);
  const MatrixXd jacobian = cost.jacobian_at(x);
  MatrixXd scores = MatrixXd::Zero(static_cast<Index>(problem.segment_count), x.size());
  for (Index i = 0; i < residuals.size(); ++i)
    scores.row(static_cast<Index>(problem.segments[static_cast<std::size_t>(i)])) +=
        residuals[i] * jacobian.row(i);
  const Information information = inverted(jacobian.transpose() * jacobian);
  const MatrixXd& inverse = information.inverse;
  const auto segments = static_cast<double>(problem.segment_count);
  out.degrees_of_freedom = std::max(1, static_cast<int>(problem.segment_count) - static_cast<int>(x.size()));
  const double correction = segments / static_cast<double>(out.degrees_of_freedom);
  const MatrixXd by_segments = inverse * (scores.transpose() * scores) * inverse;
  VectorXd wider = VectorXd::Ones(x.size());
  if (problem.disturbances_last) wider = widening(by_segments, inverse * lasting_products(scores) * inverse);
  const MatrixXd covariance =
      correction * wider.asDiagonal() * by_segments * wider.asDiagonal() + information.unseen;
  out.parameters = x.cwiseProduct(problem.scale);
  out.covariance = problem.scale.asDiagonal() * covariance * problem.scale.asDiagonal();
  out.channel_spread.assign(cost.spread().data(), cost.spread().data() + cost.spread().size());
  return out;
}

}  // namespace swiftlet::identification

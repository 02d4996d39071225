// Fits with a known closed-form solution.
#include "swiftlet/identification/fitting/series_fit.hpp"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::identification::series_fit_test {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFar = 1e6;

SeriesProblem problem_of(int parameters, const std::vector<std::size_t>& segments,
                         std::size_t segment_count) {
  SeriesProblem problem;
  problem.start = VectorXd::Zero(parameters);
  problem.scale = VectorXd::Ones(parameters);
  problem.low = VectorXd::Constant(parameters, -kFar);
  problem.high = VectorXd::Constant(parameters, kFar);
  problem.channels = {{0, segments.size()}};
  problem.segments = segments;
  problem.segment_count = segment_count;
  return problem;
}

// Readings that share an error in each segment of ten.
struct Readings {
  explicit Readings(unsigned seed, double truth = 3.0) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal;
    for (std::size_t s = 0; s < kSegments; ++s) {
      const double shared = normal(generator);
      for (int i = 0; i < 10; ++i) {
        value.push_back(truth + shared + 0.3 * normal(generator));
        segment.push_back(s);
      }
    }
  }
  static constexpr std::size_t kSegments = 25;
  std::vector<double> value;
  std::vector<std::size_t> segment;
};

SeriesFit mean_of(const Readings& readings) {
  SeriesProblem problem = problem_of(1, readings.segment, Readings::kSegments);
  problem.residuals = [&](const VectorXd& x, VectorXd& out) {
    for (std::size_t i = 0; i < readings.value.size(); ++i)
      out[static_cast<Index>(i)] = readings.value[i] - x[0];
  };
  return fit_series(problem);
}

// The standard error of a mean of S independent means: sqrt(sum (mean_s - mean)^2 / (S (S - 1))).
TEST(SeriesFit, ErrorOfAMeanFollowsFromTheSegmentMeans) {
  const Readings readings(1);
  const SeriesFit fit = mean_of(readings);
  std::vector<double> means(Readings::kSegments, 0.0);
  for (std::size_t i = 0; i < readings.value.size(); ++i)
    means[readings.segment[i]] += 0.1 * readings.value[i];
  double mean = 0.0;
  for (const double m : means) mean += m / static_cast<double>(means.size());
  double squares = 0.0;
  for (const double m : means) squares += (m - mean) * (m - mean);
  const double count = static_cast<double>(means.size());
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters[0], mean, 1e-5);
  EXPECT_NEAR(fit.covariance(0, 0), squares / (count * (count - 1.0)), 1e-4 * fit.covariance(0, 0));
  EXPECT_EQ(fit.degrees_of_freedom, 24);
  EXPECT_EQ(fit.residuals.size(), 250);
}

// With all 250 readings taken as independent, the error would be a third of the true one and 2 of 3 intervals
// would miss.
TEST(SeriesFit, CoversTheTruthOfCorrelatedReadings) {
  constexpr int kDraws = 300;
  int covered = 0;
  for (unsigned seed = 1; seed <= kDraws; ++seed) {
    const SeriesFit fit = mean_of(Readings(seed));
    covered +=
        std::abs(fit.parameters[0] - 3.0) < 2.064 * std::sqrt(fit.covariance(0, 0)) ? 1 : 0;  // t of 24, 95 %
  }
  EXPECT_NEAR(static_cast<double>(covered) / kDraws, 0.95, 3.0 * std::sqrt(0.95 * 0.05 / kDraws));
}

// GIVEN two instruments of one value, the second noisier: each is weighted by the inverse square of its
// spread about the common value
TEST(SeriesFit, WeighsChannelsByTheirSpread) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  std::vector<double> fine, coarse;
  std::vector<std::size_t> segments;
  for (std::size_t i = 0; i < 100; ++i) fine.push_back(5.0 + 0.1 * normal(generator));
  for (std::size_t i = 0; i < 60; ++i) coarse.push_back(5.0 + 10.0 * normal(generator));
  for (std::size_t i = 0; i < 160; ++i) segments.push_back(i);
  SeriesProblem problem = problem_of(1, segments, 160);
  problem.channels = {{0, 100}, {100, 60}};
  problem.residuals = [&](const VectorXd& x, VectorXd& out) {
    for (std::size_t i = 0; i < 160; ++i)
      out[static_cast<Index>(i)] = (i < 100 ? fine[i] : coarse[i - 100]) - x[0];
  };
  const SeriesFit fit = fit_series(problem);
  const auto spread_about = [](const std::vector<double>& values, double at) {
    double squares = 0.0;
    for (const double v : values) squares += (v - at) * (v - at);
    return std::sqrt(squares / static_cast<double>(values.size()));
  };
  double expected = 5.0;
  for (int round = 0; round < 20; ++round) {
    double weights = 0.0;
    double weighted_sum = 0.0;
    for (const std::vector<double>& values : {fine, coarse}) {
      const double weight = std::pow(spread_about(values, expected), -2);
      for (const double v : values) {
        weights += weight;
        weighted_sum += weight * v;
      }
    }
    expected = weighted_sum / weights;
  }
  EXPECT_NEAR(fit.parameters[0], expected, 2e-4);
  ASSERT_EQ(fit.channel_spread.size(), 2U);
  EXPECT_NEAR(fit.channel_spread[0], spread_about(fine, expected), 1e-3);
  EXPECT_NEAR(fit.channel_spread[1], spread_about(coarse, expected), 0.1);
}

// y = a exp(-b t) without noise, with parameters of very different scales.
TEST(SeriesFit, ConvergesFromADistantStart) {
  std::vector<std::size_t> segments;
  for (std::size_t i = 0; i < 200; ++i) segments.push_back(i / 10);
  SeriesProblem problem = problem_of(2, segments, 20);
  problem.start << 500.0, 1e-3;
  problem.scale << 100.0, 1e-3;
  problem.residuals = [](const VectorXd& x, VectorXd& out) {
    for (Index i = 0; i < 200; ++i) {
      const double t = 5.0 * static_cast<double>(i);
      out[i] = 800.0 * std::exp(-4e-3 * t) - x[0] * std::exp(-x[1] * t);
    }
  };
  const SeriesFit fit = fit_series(problem);
  EXPECT_TRUE(fit.converged);
  EXPECT_NEAR(fit.parameters[0], 800.0, 1e-2);
  EXPECT_NEAR(fit.parameters[1], 4e-3, 1e-7);
}

TEST(SeriesFit, StaysWithinBounds) {
  const Readings readings(5);
  SeriesProblem problem = problem_of(1, readings.segment, Readings::kSegments);
  problem.high[0] = 2.0;
  problem.residuals = [&](const VectorXd& x, VectorXd& out) {
    EXPECT_LE(x[0], 2.0 + 1e-12);
    for (std::size_t i = 0; i < readings.value.size(); ++i)
      out[static_cast<Index>(i)] = readings.value[i] - x[0];
  };
  EXPECT_NEAR(fit_series(problem).parameters[0], 2.0, 1e-6);
}

// A parameter that no reading depends on has a large variance and does not affect the others.
TEST(SeriesFit, ReportsUnobservableParametersAsUnknown) {
  const Readings readings(6);
  SeriesProblem problem = problem_of(2, readings.segment, Readings::kSegments);
  problem.scale[1] = 0.01;
  problem.residuals = [&](const VectorXd& x, VectorXd& out) {
    for (std::size_t i = 0; i < readings.value.size(); ++i)
      out[static_cast<Index>(i)] = readings.value[i] - x[0];
  };
  const SeriesFit fit = fit_series(problem);
  const SeriesFit alone = mean_of(readings);
  EXPECT_NEAR(fit.parameters[0], alone.parameters[0], 1e-5);
  EXPECT_NEAR(std::sqrt(fit.covariance(1, 1)), 1e4 * 0.01, 1e-3);
  // One more parameter is one degree of freedom less.
  EXPECT_NEAR(fit.covariance(0, 0) / alone.covariance(0, 0), 24.0 / 23.0, 1e-3);
}

}  // namespace swiftlet::identification::series_fit_test

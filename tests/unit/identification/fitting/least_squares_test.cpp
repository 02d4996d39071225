#include "swiftlet/identification/fitting/least_squares.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "swiftlet/math/random.hpp"

namespace swiftlet::identification::least_squares_test {

// y = 2 x + 1 with noise, rows at x = 0 .. 1.
struct Line {
  std::vector<double> x, y;

  Line(int rows, double sigma, std::uint64_t seed) {
    math::RandomStream random(seed, 1);
    for (int i = 0; i < rows; ++i) {
      x.push_back(i / (rows - 1.0));
      y.push_back(2.0 * x.back() + 1.0 + sigma * random.normal());
    }
  }

  FitProblem problem() const {
    FitProblem out;
    out.observations = x.size();
    out.start = Eigen::Vector2d(1.0, 1.0);
    out.residuals = [this](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        residuals[row] = y[i] - p[0] * x[i] - p[1];
        if (jacobian != nullptr) jacobian->row(row) << -x[i], -1.0;
      }
    };
    return out;
  }
};

TEST(LeastSquares, IsExactWithoutNoise) {
  const Line line(10, 0.0, 1);
  const Fit found = fit(line.problem());
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(found.parameters[0], 2.0, 1e-9);
  EXPECT_NEAR(found.parameters[1], 1.0, 1e-9);
  EXPECT_TRUE(found.outliers.empty());
  EXPECT_LT(found.standard_error(0), 1e-9);
}

TEST(LeastSquares, AgreesWithTheClosedForm) {
  const Line line(200, 0.1, 2);
  const Fit found = fit(line.problem());
  Eigen::MatrixXd design(200, 2);
  Eigen::VectorXd reading(200);
  for (Eigen::Index i = 0; i < 200; ++i) {
    design.row(i) << line.x[static_cast<std::size_t>(i)], 1.0;
    reading[i] = line.y[static_cast<std::size_t>(i)];
  }
  const Eigen::Vector2d exact = (design.transpose() * design).ldlt().solve(design.transpose() * reading);
  EXPECT_NEAR(found.parameters[0], exact[0], 1e-8);
  EXPECT_NEAR(found.parameters[1], exact[1], 1e-8);
  EXPECT_EQ(found.degrees_of_freedom, 198);
  // The covariance for equal variances, which HC3 approaches with many rows.
  const Eigen::Matrix2d covariance = found.sigma * found.sigma * (design.transpose() * design).inverse();
  EXPECT_NEAR(found.standard_error(0) / std::sqrt(covariance(0, 0)), 1.0, 0.15);
  EXPECT_NEAR(found.correlation(0, 1), covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)),
              0.1);
}

TEST(LeastSquares, ListsOutliersAndKeepsTheRest) {
  Line line(40, 0.01, 3);
  for (const std::size_t row : {3U, 11U, 25U, 38U}) line.y[row] += 0.5;
  const Fit found = fit(line.problem());
  EXPECT_EQ(found.outliers, (std::vector<std::size_t>{3, 11, 25, 38}));
  EXPECT_NEAR(found.parameters[0], 2.0, 0.03);
  EXPECT_TRUE(found.is_outlier(25));
  EXPECT_FALSE(found.is_outlier(24));
}

// GIVEN a third of the rows at ten times their x: a fit that starts from all rows follows them
TEST(LeastSquares, ResistsOutliersWithHighLeverage) {
  Line line(30, 0.01, 4);
  for (std::size_t row = 20; row < 30; ++row) line.x[row] *= 10.0;
  const Fit found = fit(line.problem());
  EXPECT_EQ(found.outliers.size(), 10U);
  EXPECT_NEAR(found.parameters[0], 2.0, 0.05);
}

TEST(LeastSquares, RarelyFlagsGoodRowsAsOutliers) {
  int with_outliers = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const Line line(40, 0.1, seed);
    with_outliers += fit(line.problem()).outliers.empty() ? 0 : 1;
  }
  EXPECT_LE(with_outliers, 15);  // 1 % of 500 expected; more than 3 standard deviations of that allowed
}

TEST(LeastSquares, WidensIntervalsOfCorrelatedSeries) {
  Line line(400, 0.0, 5);
  math::RandomStream random(6, 1);
  double drift = 0.0;
  for (double& y : line.y) y += 0.1 * (drift = 0.9 * drift + std::sqrt(1.0 - 0.81) * random.normal());
  FitProblem problem = line.problem();
  const Fit as_independent = fit(problem);
  problem.time_series = true;
  const Fit as_series = fit(problem);
  EXPECT_NEAR(as_series.serial_correlation, 0.9, 0.06);
  EXPECT_GT(as_series.standard_error(0), 3.0 * as_independent.standard_error(0));
}

TEST(LeastSquares, ReportsCollinearParameters) {
  Line line(40, 0.01, 7);
  for (double& x : line.x) x = 1.0 + 1e-3 * x;
  EXPECT_GT(fit(line.problem()).condition, 1000.0);
  EXPECT_LT(fit(Line(40, 0.01, 7).problem()).condition, 10.0);
}

TEST(LeastSquares, IntervalFactorFollowsStudentsT) {
  EXPECT_NEAR(interval_factor(10), 2.2281, 1e-4);
  EXPECT_NEAR(interval_factor(1000000), 1.95996, 1e-4);
}

}  // namespace swiftlet::identification::least_squares_test

#include "swiftlet/plant/simulation/wind_model.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::tests::wind_model_test {

using Eigen::Vector3d;
using plant::AirSettings;
using plant::WindModel;

TEST(WindModel, IsConstantWithoutGusts) {
  AirSettings settings;
  settings.wind_ned = {3.0, -2.0, 1.0};
  WindModel air(settings, 0.001, 1);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(air.wind_ned(), settings.wind_ned);
    air.advance();
  }
}

TEST(WindModel, GustsHaveTheirVarianceAndCorrelationTime) {
  AirSettings settings;
  settings.wind_ned = {3.0, -2.0, 0.0};
  settings.gust_sigma_ned = {1.0, 0.5, 0.0};
  settings.gust_time_constant_s = 0.2;
  constexpr double kStep = 0.002;
  constexpr int kCount = 2'000'000;  // 4000 s, about 10 000 independent ones
  constexpr int kLag = 100;          // one time constant
  WindModel air(settings, kStep, 3);

  Vector3d sum = Vector3d::Zero();
  Vector3d squares = Vector3d::Zero();
  Vector3d products = Vector3d::Zero();
  double across = 0.0;
  std::vector<Vector3d> past(kLag, Vector3d::Zero());
  for (std::size_t i = 0; i < kCount; ++i) {
    air.advance();
    const Vector3d gust = air.wind_ned() - settings.wind_ned;
    sum += gust;
    squares += gust.cwiseAbs2();
    products += gust.cwiseProduct(past[i % kLag]);
    across += gust.x() * gust.y();
    past[i % kLag] = gust;
  }
  // The standard deviation of these means is about 1 % of the variance; the bounds are four of them.
  for (int axis = 0; axis < 2; ++axis) {
    const double variance = std::pow(settings.gust_sigma_ned[axis], 2);
    EXPECT_NEAR(sum[axis] / kCount, 0.0, 0.04 * settings.gust_sigma_ned[axis]);
    EXPECT_NEAR(squares[axis] / kCount, variance, 0.04 * variance);
    EXPECT_NEAR(products[axis] / kCount, variance * std::exp(-1.0), 0.04 * variance);
  }
  EXPECT_NEAR(across / kCount, 0.0, 0.04 * 0.5);
  EXPECT_EQ(squares.z(), 0.0);
}

TEST(WindModel, GustsHaveTheirVarianceFromTheStart) {
  AirSettings settings;
  settings.gust_sigma_ned = {1.0, 1.0, 1.0};
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed)
    squares += WindModel(settings, 0.001, seed).wind_ned().squaredNorm();
  EXPECT_NEAR(squares / 9000.0, 1.0, 0.06);
}

// MIL-F-8785C, section 3.7.3.4: at 10 ft and an airspeed of 10 ft/s the lengths are 10 ft vertically and
// 10 / (0.177 + 0.00823)^1.2 = 75.6 ft.
TEST(WindModel, DrydenLengthsAreThoseOfTheStandard) {
  const Vector3d times_s = plant::dryden_times_s({10 * 0.3048, 10 * 0.3048});
  EXPECT_NEAR(times_s.z(), 1.0, 1e-12);
  EXPECT_NEAR(times_s.x(), std::pow(0.177 + 0.00823, -1.2), 1e-12);
  EXPECT_EQ(times_s.y(), times_s.x());
}

// GIVEN a wind towards the south east WHEN Dryden gusts blow THEN they correlate along it as exp(-t / T), and across it and
// vertically as exp(-t / T) (1 - t / 2T), with the variance of the settings.
TEST(WindModel, DrydenGustsHaveTheirCorrelations) {
  AirSettings settings;
  settings.wind_ned = {-3.0, 3.0, 0.0};
  settings.gust_sigma_ned = {1.0, 1.0, 0.5};
  settings.dryden = {0.3048, 5.0};  // times of 0.48 s horizontally, 0.061 s vertically
  const Vector3d times_s = plant::dryden_times_s(settings.dryden);
  constexpr double kStep = 0.002;
  constexpr std::size_t kCount = 4'000'000;
  WindModel air(settings, kStep, 5);
  Eigen::Matrix3d to_wind;
  to_wind << -std::sqrt(0.5), std::sqrt(0.5), 0.0, -std::sqrt(0.5), -std::sqrt(0.5), 0.0, 0.0, 0.0, 1.0;
  const Vector3d sigma(1.0, 1.0, 0.5);
  std::vector<Vector3d> gusts(kCount);
  Vector3d squares = Vector3d::Zero();
  for (Vector3d& gust : gusts) {
    air.advance();
    gust = (to_wind * (air.wind_ned() - settings.wind_ned)).cwiseQuotient(sigma);
    squares += gust.cwiseAbs2() / kCount;
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(squares[axis], 1.0, 0.05) << axis;
    for (const double lag : {0.5, 1.0, 2.0}) {
      const auto steps = static_cast<std::size_t>(std::lround(lag * times_s[axis] / kStep));
      double product = 0.0;
      for (std::size_t i = steps; i < kCount; ++i) product += gusts[i][axis] * gusts[i - steps][axis];
      const double expected = std::exp(-lag) * (axis == 0 ? 1.0 : 1.0 - 0.5 * lag);
      EXPECT_NEAR(product / static_cast<double>(kCount - steps), expected, 0.05) << axis << " at " << lag;
    }
  }
}

TEST(WindModel, DrydenGustsHaveTheirVarianceFromTheStart) {
  AirSettings settings;
  settings.gust_sigma_ned = {1.0, 1.0, 1.0};
  settings.dryden = {1.0, 2.0};
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 3000; ++seed)
    squares += WindModel(settings, 0.001, seed).wind_ned().squaredNorm();
  EXPECT_NEAR(squares / 9000.0, 1.0, 0.06);
}

}  // namespace swiftlet::tests::wind_model_test

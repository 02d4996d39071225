#include "plant/simulation/random.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "plant/simulation/streams.hpp"

namespace swiftlet::plant {
namespace {

constexpr int kDraws = 20'000;

TEST(RandomStream, UniformFillsItsRangeEvenly) {
  RandomStream random(7, 100);
  double sum = 0.0;
  double least = 5.0;
  double most = -2.0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.uniform(-2.0, 5.0);
    sum += value;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_NEAR(sum / kDraws, 1.5, 5.0 * 7.0 / std::sqrt(12.0 * kDraws));
  EXPECT_GE(least, -2.0);
  EXPECT_LT(least, -1.99);
  EXPECT_LE(most, 5.0);
  EXPECT_GT(most, 4.99);
}

TEST(RandomStream, LogUniformHasAUniformLogarithm) {
  RandomStream random(7, 100);
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.log_uniform(1e-4, 10.0);
    ASSERT_GE(value, 1e-4);
    ASSERT_LE(value, 10.0);
    sum += std::log10(value);
  }
  EXPECT_NEAR(sum / kDraws, -1.5, 5.0 * 5.0 / std::sqrt(12.0 * kDraws));
}

TEST(RandomStream, LogUniformIsTheExponentialOfTheUniform) {
  RandomStream one(3, 1);
  RandomStream other(3, 1);
  for (int i = 0; i < 1000; ++i) {
    const double expected = 1e-6 * std::pow(1e8, one.uniform());
    EXPECT_NEAR(other.log_uniform(1e-6, 1e2) / expected, 1.0, 1e-13);
  }
}

TEST(RandomStream, TruncatedNormalKeepsItsLimits) {
  RandomStream random(7, 100);
  double sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double value = random.truncated_normal(1.0, 0.5, 0.5, 2.0);
    ASSERT_GE(value, 0.5);
    ASSERT_LE(value, 2.0);
    sum += value;
  }
  // mu + sigma (phi(a) - phi(b)) / (Phi(b) - Phi(a)), a = -1, b = 2.
  const auto phi = [](double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI); };
  const auto cumulative = [](double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); };
  const double mean = 1.0 + 0.5 * (phi(-1.0) - phi(2.0)) / (cumulative(2.0) - cumulative(-1.0));
  EXPECT_NEAR(sum / kDraws, mean, 5.0 * 0.5 / std::sqrt(kDraws));
}

TEST(RandomStream, DrawsAreTheSameOnEveryMachine) {
  RandomStream random(42, streams::of_name("vehicle.mass"));
  EXPECT_EQ(random.uniform(0.9, 1.1), 0x1.f2b9adaddbd2cp-1);
  EXPECT_EQ(random.log_uniform(1e-3, 1.0), 0x1.2d92c2352dc3ap-9);
  EXPECT_EQ(random.truncated_normal(1.0, 0.1, 0.8, 1.2), 0x1.116f0e2621235p+0);
}

}  // namespace
}  // namespace swiftlet::plant

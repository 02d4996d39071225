#include "swiftlet/math/random.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::tests::random_test {

using math::kZiggurat;
using math::RandomStream;
using math::Ziggurat;

// Cumulative distribution function of the standard normal distribution.
double share_below(double x) { return 0.5 * std::erfc(-x / std::sqrt(2.0)); }

TEST(Random, ZigguratLayersHaveEqualAreasAndEndAtThePeak) {
  const double area = kZiggurat.edge[0] * kZiggurat.height[1];
  for (std::size_t i = 1; i < Ziggurat::kLayers; ++i) {
    EXPECT_LT(kZiggurat.edge[i], kZiggurat.edge[i - 1]);
    EXPECT_NEAR(kZiggurat.height[i], std::exp(-0.5 * kZiggurat.edge[i] * kZiggurat.edge[i]), 1e-15);
    const double top = kZiggurat.height[i] + area / kZiggurat.edge[i];
    const bool last = i + 1 == Ziggurat::kLayers;
    EXPECT_NEAR(kZiggurat.height[i + 1], top, last ? 1e-12 : 1e-15);
  }
  const double tail = std::sqrt(2.0 * std::acos(-1.0)) * share_below(-kZiggurat.edge[1]);
  EXPECT_NEAR(area, kZiggurat.edge[1] * kZiggurat.height[1] + tail, 1e-15);
}

TEST(Random, NormalSamplesFollowTheDistribution) {
  RandomStream random(7, 1);
  constexpr std::size_t kCount = 1'000'000;
  std::vector<double> draws(kCount);
  std::generate(draws.begin(), draws.end(), [&] { return random.normal(); });

  std::array<double, 5> moments{};
  for (const double x : draws) {
    double power = 1.0;
    for (double& moment : moments) moment += (power *= x) / kCount;
  }
  // Five standard deviations of each: the n-th moment's variance is E[x^2n] - E[x^n]^2.
  EXPECT_NEAR(moments[0], 0.0, 5.0 * std::sqrt(1.0 / kCount));
  EXPECT_NEAR(moments[1], 1.0, 5.0 * std::sqrt(2.0 / kCount));
  EXPECT_NEAR(moments[2], 0.0, 5.0 * std::sqrt(15.0 / kCount));
  EXPECT_NEAR(moments[3], 3.0, 5.0 * std::sqrt(96.0 / kCount));
  EXPECT_NEAR(moments[4], 0.0, 5.0 * std::sqrt(945.0 / kCount));

  // Kolmogorov and Smirnov: above 1.95 / sqrt(n) once in a thousand seeds.
  std::sort(draws.begin(), draws.end());
  double distance = 0.0;
  for (std::size_t i = 0; i < kCount; ++i) {
    const double share = share_below(draws[i]);
    distance = std::max(
        {distance, share - static_cast<double>(i) / kCount, static_cast<double>(i + 1) / kCount - share});
  }
  EXPECT_LT(distance, 1.95 / std::sqrt(kCount));
}

// The sum covers every part of the ziggurat.
TEST(Random, DrawsTheSameBitsOnEveryMachine) {
  RandomStream random(1, 2);
  EXPECT_EQ(random.normal(), 0x1.be45993b8bd22p+0);
  EXPECT_EQ(random.normal(), -0x1.2eaf5b55cf2e5p-2);
  EXPECT_EQ(random.normal(), 0x1.03276c8ff5058p+0);
  double sum = 0.0;
  for (int i = 0; i < 100'000; ++i) sum += random.normal();
  EXPECT_EQ(sum, 0x1.2c21e16f51779p+6);
}

// The ziggurat draws the tail by another method: about 2.6 of 10,000 draws.
TEST(Random, NormalTailHasTheRightFrequency) {
  RandomStream random(8, 1);
  const double tail = kZiggurat.edge[1];
  constexpr int kCount = 20'000'000;
  std::array<int, 2> beyond{};  // left, right
  int far = 0;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    if (std::abs(x) > tail) ++beyond[x > 0.0 ? 1 : 0];
    if (std::abs(x) > 4.5) ++far;
  }
  const double expected = kCount * share_below(-tail);
  EXPECT_NEAR(beyond[0], expected, 5.0 * std::sqrt(expected));
  EXPECT_NEAR(beyond[1], expected, 5.0 * std::sqrt(expected));
  const double expected_far = 2.0 * kCount * share_below(-4.5);
  EXPECT_NEAR(far, expected_far, 5.0 * std::sqrt(expected_far));
}

TEST(Random, SuccessiveSamplesAndStreamsAreUncorrelated) {
  RandomStream one(9, 1);
  RandomStream other(9, 2);
  constexpr int kCount = 1'000'000;
  double last = 0.0, neighbours = 0.0, neighbour_squares = 0.0, streams = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const double x = one.normal();
    neighbours += x * last;
    neighbour_squares += (x * x - 1.0) * (last * last - 1.0);
    streams += x * other.normal();
    last = x;
  }
  EXPECT_NEAR(neighbours / kCount, 0.0, 5.0 / std::sqrt(kCount));
  EXPECT_NEAR(neighbour_squares / kCount, 0.0, 5.0 * 2.0 / std::sqrt(kCount));
  EXPECT_NEAR(streams / kCount, 0.0, 5.0 / std::sqrt(kCount));
}

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

TEST(RandomStream, TruncatedNormalStaysWithinItsLimits) {
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

TEST(RandomStream, DistributionsDrawTheSameBitsOnEveryMachine) {
  RandomStream random(42, plant::streams::of_name("vehicle.mass"));
  EXPECT_EQ(random.uniform(0.9, 1.1), 0x1.f2b9adaddbd2cp-1);
  EXPECT_EQ(random.log_uniform(1e-3, 1.0), 0x1.2d92c2352dc3ap-9);
  EXPECT_EQ(random.truncated_normal(1.0, 0.1, 0.8, 1.2), 0x1.0d6ab6c47fc08p+0);
}

}  // namespace swiftlet::tests::random_test

#include "swiftlet/control/planning/bernstein.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace swiftlet::control::bernstein_test {

Polynomial random_polynomial(std::mt19937& generator) {
  std::uniform_real_distribution<double> coefficient(-1.0, 1.0);
  Polynomial polynomial{};
  for (double& c : polynomial) c = coefficient(generator);
  return polynomial;
}

// d^k/dt^k of the sum of c[i] t^i, term by term.
double value(const Polynomial& c, int k, double t) {
  double sum = 0.0;
  for (int i = k; i < kPolynomialCoefficients; ++i) {
    double factor = 1.0;
    for (int j = 0; j < k; ++j) factor *= i - j;
    sum += factor * c[static_cast<std::size_t>(i)] * std::pow(t, i - k);
  }
  return sum;
}

// By de Casteljau's scheme.
double value(Bernstein p, double u) {
  for (int n = p.degree; n > 0; --n) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
      p.c[i] = (1.0 - u) * p.c[i] + u * p.c[i + 1];
  }
  return p.c[0];
}

TEST(Bernstein, EqualsThePolynomial) {
  std::mt19937 generator(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Polynomial a = random_polynomial(generator);
    const Polynomial b = random_polynomial(generator);
    const double T = 0.3 + 0.15 * trial;
    for (int k = 0; k < kPolynomialCoefficients; ++k) {
      const Bernstein p = bernstein(a, T, k);
      EXPECT_EQ(p.degree, 7 - k);
      for (const double u : {0.0, 0.25, 0.6, 1.0}) {
        const double wanted = value(a, k, u * T);
        EXPECT_NEAR(value(p, u), wanted, 1e-11 * (1.0 + std::abs(wanted)));
      }
    }
    const Bernstein p = bernstein(a, T);
    const Bernstein q = bernstein(b, T, 3);
    for (const double u : {0.0, 0.3, 0.8, 1.0}) {
      const double x = value(p, u);
      const double y = value(q, u);
      const double size = 1.0 + std::abs(x) + std::abs(y);
      EXPECT_NEAR(value(p + q, u), x + y, 1e-12 * size);
      EXPECT_NEAR(value(q - 2.0 * p, u), y - 2.0 * x, 1e-12 * size);
      EXPECT_NEAR(value(p * q, u), x * y, 1e-12 * size * size);
      EXPECT_NEAR(value(squared_length(p, q, constant(2.0)), u), x * x + y * y + 4.0, 1e-12 * size * size);
    }
  }
}

TEST(Bernstein, ExtremaHoldForTheWholeSegment) {
  std::mt19937 generator(2);
  constexpr double kTolerance = 1e-8;
  for (int trial = 0; trial < 200; ++trial) {
    const Bernstein p = bernstein(random_polynomial(generator), 2.0, trial % 4);
    const Extremum most = maximum(p, kTolerance);
    const Extremum least = minimum(p, kTolerance);
    const double rounding = 1e-12 * (std::abs(p.greatest()) + std::abs(p.least()));
    EXPECT_NEAR(value(p, most.at), most.value, rounding);
    EXPECT_NEAR(value(p, least.at), least.value, rounding);
    EXPECT_LE(most.value, p.greatest());
    EXPECT_GE(least.value, p.least());
    for (int i = 0; i <= 2000; ++i) {
      const double there = value(p, i / 2000.0);
      ASSERT_LE(there, most.value + kTolerance + rounding);
      ASSERT_GE(there, least.value - kTolerance - rounding);
    }
  }
}

TEST(Bernstein, FindsANarrowPeak) {
  // 1 - 4e4 (t - 0.123)^2 is above 0 for 10 ms only.
  Polynomial narrow{};
  narrow[0] = 1.0 - 4e4 * 0.123 * 0.123;
  narrow[1] = 2.0 * 4e4 * 0.123;
  narrow[2] = -4e4;
  const Extremum peak = maximum(bernstein(narrow, 10.0), 1e-6);
  EXPECT_NEAR(peak.value, 1.0, 2e-6);
  EXPECT_NEAR(10.0 * peak.at, 0.123, 1e-4);
}

TEST(Bernstein, ConstantIsItsOwnExtremum) {
  const Extremum peak = maximum(constant(-3.5), 1e-9);
  EXPECT_EQ(peak.value, -3.5);
  EXPECT_EQ(minimum(bernstein({2.0}, 1.0), 0.0).value, 2.0);
}

// With a tolerance of 0, rounding errors leave each part of a constant in doubt.
TEST(Bernstein, BoundsTheSearchForAMaximum) {
  Bernstein flat;
  flat.degree = kMaxBernsteinDegree;
  for (std::size_t i = 0; i < flat.c.size(); ++i) flat.c[i] = i % 2 == 0 ? 0.1 : 0.1 + 1e-13;
  const Extremum most = maximum(flat, 0.0);
  EXPECT_LE(most.value, 0.1 + 1e-13);
  const Extremum least = minimum(flat, 0.0);
  EXPECT_GE(least.value, 0.1);
  for (int i = 0; i <= 1000; ++i) {
    EXPECT_GE(most.value, value(flat, i / 1000.0) - 1e-15);
    EXPECT_LE(least.value, value(flat, i / 1000.0) + 1e-15);
  }
}

// A tolerance far below 0 leaves every part in doubt.
TEST(Bernstein, BoundsTheExtremaWhenSubdivisionsDoNotSuffice) {
  std::mt19937 generator(3);
  for (int trial = 0; trial < 20; ++trial) {
    const Bernstein p = bernstein(random_polynomial(generator), 2.0);
    const Extremum most = maximum(p, -1e9);
    const Extremum least = minimum(p, -1e9);
    const double rounding = 1e-12 * (std::abs(p.greatest()) + std::abs(p.least()));
    for (int i = 0; i <= 1000; ++i) {
      ASSERT_GE(most.value, value(p, i / 1000.0) - rounding);
      ASSERT_LE(least.value, value(p, i / 1000.0) + rounding);
    }
    for (const double end : {0.0, 1.0}) {
      EXPECT_GE(value(p, most.at), value(p, end) - rounding) << "the best point found";
      EXPECT_LE(value(p, least.at), value(p, end) + rounding) << "the best point found";
    }
  }
}

}  // namespace swiftlet::control::bernstein_test

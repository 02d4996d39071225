#include "swiftlet/identification/fitting/arma_noise.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/math/random.hpp"

namespace swiftlet::identification::arma_noise_test {

constexpr double kReflection[kNoiseParameters] = {0.4, -0.3, -0.9, 0.5};

// v = C / D e, by definition.
std::vector<double> coloured(const ArmaNoise& noise, const std::vector<double>& e) {
  std::vector<double> v(e.size(), 0.0);
  for (std::size_t k = 0; k < e.size(); ++k) {
    v[k] = e[k];
    for (std::size_t i = 0; i < kNoiseOrder && i < k; ++i)
      v[k] += noise.numerator[i] * e[k - 1 - i] - noise.denominator[i] * v[k - 1 - i];
  }
  return v;
}

std::vector<double> white(std::size_t count) {
  math::RandomStream random(7, 20251121);
  std::vector<double> out(count);
  out[0] = 0.0;
  for (std::size_t k = 1; k < count; ++k) out[k] = random.normal();
  return out;
}

TEST(ArmaNoise, InnovationsInvertTheFilter) {
  const ArmaNoise noise = arma_noise(kReflection);
  const std::vector<double> e = white(500);
  const std::vector<double> found = innovations(noise, coloured(noise, e));
  for (std::size_t k = 0; k < e.size(); ++k) ASSERT_NEAR(found[k], e[k], 1e-9) << k;
}

// The roots of q^2 + a q + b lie inside the unit circle if and only if |b| < 1 and |a| < 1 + b.
TEST(ArmaNoise, IsStableForAllReflectionsBelowOne) {
  for (double first = -0.99; first < 1.0; first += 0.06) {
    for (double second = -0.99; second < 1.0; second += 0.06) {
      const double reflection[kNoiseParameters] = {first, second, second, first};
      for (const auto& polynomial : {arma_noise(reflection).numerator, arma_noise(reflection).denominator}) {
        EXPECT_LT(std::abs(polynomial[1]), 1.0);
        EXPECT_LT(std::abs(polynomial[0]), 1.0 + polynomial[1]);
      }
    }
  }
}

TEST(ArmaNoise, PredictionAssumesZeroFutureInnovations) {
  const ArmaNoise noise = arma_noise(kReflection);
  std::vector<double> e = white(60);
  for (std::size_t k = 40; k < e.size(); ++k) e[k] = 0.0;
  const std::vector<double> v = coloured(noise, e);
  const std::vector<double> expected = expected_noise(noise, v, e, 40, 20);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(expected[i], v[40 + i], 1e-12) << i;
}

}  // namespace swiftlet::identification::arma_noise_test

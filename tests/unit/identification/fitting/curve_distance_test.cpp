#include "swiftlet/identification/fitting/curve_distance.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/identification/fitting/recent_results.hpp"

namespace swiftlet::identification::curve_distance_test {

// In units of the spreads, the distance to a straight line is the perpendicular one.
TEST(CurveDistance, OfALineIsPerpendicular) {
  const auto line = [](double x) { return CurveValue{2.0 * x + 1.0, 2.0}; };
  const double x_spread = 0.5;
  const double y_spread = 3.0;
  const CurveDistance found = curve_distance(line, 4.0, 20.0, x_spread, y_spread);
  EXPECT_NEAR(found.distance, (20.0 - 9.0) / std::hypot(y_spread, 2.0 * x_spread), 1e-12);
  EXPECT_NEAR(found.spread, std::hypot(y_spread, 2.0 * x_spread), 1e-12);
  EXPECT_LT(curve_distance(line, 4.0, 2.0, x_spread, y_spread).distance, 0.0) << "below the line";
  const CurveDistance exact_x = curve_distance(line, 4.0, 20.0, 0.0, y_spread);
  EXPECT_NEAR(exact_x.distance, 11.0 / 3.0, 1e-12);
  EXPECT_EQ(exact_x.x, 4.0);
}

// Compared with a search over x.
TEST(CurveDistance, OfAParabolaIsTheMinimum) {
  const auto parabola = [](double x) { return CurveValue{0.5 * x * x, x}; };
  constexpr double kXSpread = 0.05;
  constexpr double kYSpread = 0.1;
  for (const double x_read : {0.3, 1.0, 2.5}) {
    for (const double off : {-0.3, -0.05, 0.1, 0.3}) {
      const double y_read = 0.5 * x_read * x_read + off;
      double least = std::numeric_limits<double>::infinity();
      double at = 0.0;
      for (double x = x_read - 0.5; x < x_read + 0.5; x += 1e-5) {
        const double y = (y_read - 0.5 * x * x) / kYSpread;
        const double squared = y * y + std::pow((x_read - x) / kXSpread, 2);
        if (squared < least) {
          least = squared;
          at = x;
        }
      }
      const CurveDistance found = curve_distance(parabola, x_read, y_read, kXSpread, kYSpread);
      EXPECT_NEAR(found.distance, std::copysign(std::sqrt(least), off), 1e-6) << x_read << " " << off;
      EXPECT_NEAR(found.x, at, 2e-5) << x_read << " " << off;
    }
  }
}

TEST(RecentResults, AreComputedOnceWhileCached) {
  RecentResults<int, int> results(2);
  int computed = 0;
  const auto of = [&](int key) {
    return *results.of(key, [&] {
      ++computed;
      return 10 * key;
    });
  };
  EXPECT_EQ(of(1), 10);
  EXPECT_EQ(of(2), 20);
  EXPECT_EQ(of(1), 10);
  EXPECT_EQ(computed, 2);
  EXPECT_EQ(of(3), 30) << "evicts the oldest key, 1";
  EXPECT_EQ(of(2), 20);
  EXPECT_EQ(computed, 3);
  EXPECT_EQ(of(1), 10);
  EXPECT_EQ(computed, 4);
}

// A result that a caller holds stays valid after the cache evicts it.
TEST(RecentResults, RemainValidAfterEviction) {
  RecentResults<int, int> results(1);
  const auto first = results.of(1, [] { return 11; });
  results.of(2, [] { return 22; });
  EXPECT_EQ(*first, 11);
}

}  // namespace swiftlet::identification::curve_distance_test

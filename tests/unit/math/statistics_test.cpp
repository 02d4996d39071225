#include "swiftlet/math/statistics.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace swiftlet::math::statistics_test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TEST(Spread, InterpolatesLinearlyBetweenSortedNumbers) {
  std::vector<double> numbers;
  for (int i = 100; i >= 0; --i) numbers.push_back(i);
  numbers.push_back(kNaN);
  const Spread s = spread(numbers);
  EXPECT_EQ(s.count, 101U);
  EXPECT_DOUBLE_EQ(s.min, 0.0);
  EXPECT_DOUBLE_EQ(s.p5, 5.0);
  EXPECT_DOUBLE_EQ(s.median, 50.0);
  EXPECT_DOUBLE_EQ(s.p95, 95.0);
  EXPECT_DOUBLE_EQ(s.max, 100.0);
  EXPECT_DOUBLE_EQ(spread({3.0, 1.0}).p5, 1.1);
}

TEST(Spread, IsNaNWithoutNumbers) {
  EXPECT_EQ(spread({kNaN}).count, 0U);
  EXPECT_TRUE(std::isnan(spread({}).median));
}

TEST(RankCorrelation, IsPlusOrMinusOneForMonotonicNumbers) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, 10, 100, 1000}), 1.0);
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {4, 3, 2, -7}), -1.0);
}

TEST(RankCorrelation, AveragesTheRanksOfEqualNumbers) {
  // Ranks 1, 2.5, 2.5, 4 against 1, 2, 3, 4: 4.5 / sqrt(4.5 * 5).
  EXPECT_NEAR(rank_correlation({1, 5, 5, 9}, {1, 2, 3, 4}), 4.5 / std::sqrt(4.5 * 5.0), 1e-12);
}

TEST(RankCorrelation, IgnoresPairsThatAreNotFinite) {
  EXPECT_DOUBLE_EQ(rank_correlation({1, 2, 3, 4}, {1, kNaN, 3, 4}), 1.0);
  EXPECT_TRUE(std::isnan(rank_correlation({1, 2}, {1, 2}))) << "two pairs are too few";
  EXPECT_TRUE(std::isnan(rank_correlation({1, 1, 1}, {1, 2, 3}))) << "equal values have no order";
}

}  // namespace swiftlet::math::statistics_test

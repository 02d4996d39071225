#include "swiftlet/services/runtime/latency_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::runtime::latency_histogram_test {

TEST(LatencyHistogram, IsEmptyAtFirst) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.quantile_ns(0.5), 0);
  EXPECT_EQ(histogram.max_ns(), 0);
}

TEST(LatencyHistogram, QuantilesMatchSortedValuesWithinABucket) {
  std::mt19937_64 random(1);
  std::lognormal_distribution<double> durations(std::log(80'000.0),
                                                2.0);  // ns: from below 1 us to beyond 10 ms
  LatencyHistogram histogram;
  std::vector<std::int64_t> sorted;
  for (int i = 0; i < 20'000; ++i) {
    sorted.push_back(static_cast<std::int64_t>(durations(random)));
    histogram.record(sorted.back());
  }
  std::sort(sorted.begin(), sorted.end());
  for (const double q : {0.0, 0.01, 0.25, 0.5, 0.9, 0.99, 0.999, 1.0}) {
    const auto rank =
        std::max(static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size()))), std::size_t{1});
    const std::int64_t exact = sorted[rank - 1];
    EXPECT_GE(histogram.quantile_ns(q), exact) << q;
    EXPECT_LE(static_cast<double>(histogram.quantile_ns(q)),
              static_cast<double>(exact) * (1.0 + 1.0 / 32.0) + 1.0)
        << q;
  }
  EXPECT_EQ(histogram.max_ns(), sorted.back());
  EXPECT_EQ(histogram.quantile_ns(1.0), sorted.back());
  EXPECT_EQ(histogram.count(), sorted.size());
}

TEST(LatencyHistogram, ResolvesPowersOfTwoWithinABucket) {
  for (int bit = 0; bit < 36; ++bit) {
    for (const std::int64_t offset : {-1, 0, 1}) {
      const std::int64_t value = (std::int64_t{1} << bit) + offset;
      LatencyHistogram histogram;
      histogram.record(value);
      histogram.record(value + value / 8 + 2);  // so that the maximum does not cut the quantile
      EXPECT_GE(histogram.quantile_ns(0.5), value);
      EXPECT_LE(histogram.quantile_ns(0.5), value + value / 32 + 1);
    }
  }
}

TEST(LatencyHistogram, ClampsValuesOutOfRange) {
  LatencyHistogram histogram;
  histogram.record(-5);
  EXPECT_EQ(histogram.quantile_ns(1.0), 0);
  histogram.record(std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.max_ns(), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(histogram.quantile_ns(1.0), (std::int64_t{1} << 36) - 1);
}

TEST(LatencyHistogram, ResetClearsIt) {
  LatencyHistogram histogram;
  histogram.record(1000);
  histogram.reset();
  EXPECT_EQ(histogram.count(), 0U);
  EXPECT_EQ(histogram.max_ns(), 0);
  histogram.record(7);
  EXPECT_EQ(histogram.quantile_ns(0.5), 7);
}

}  // namespace swiftlet::runtime::latency_histogram_test

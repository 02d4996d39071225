#include "swiftlet/services/runtime/latest_value.hpp"

#include <array>
#include <atomic>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::runtime::latest_value_test {

TEST(LatestValue, ReturnsTheNewestValueOnce) {
  LatestValue<int> latest;
  int value = -1;
  EXPECT_FALSE(latest.take(value));
  EXPECT_EQ(value, -1);
  latest.put(1);
  latest.put(2);
  ASSERT_TRUE(latest.take(value));
  EXPECT_EQ(value, 2);
  EXPECT_FALSE(latest.take(value));
  latest.put(3);
  ASSERT_TRUE(latest.take(value));
  EXPECT_EQ(value, 3);
}

// Values are never torn and only get newer for any interleaving; the last one put arrives.
TEST(LatestValue, ValuesAreWholeAndInOrderBetweenThreads) {
  constexpr std::uint64_t kLast = 200'000;
  using Value = std::array<std::uint64_t, 16>;
  LatestValue<Value> latest;
  std::thread writer([&] {
    Value value;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      value.fill(i);
      latest.put(value);
    }
  });
  std::uint64_t newest = 0;
  bool torn = false;
  bool went_back = false;
  Value value;
  while (newest < kLast) {
    if (!latest.take(value)) continue;
    for (const std::uint64_t part : value) torn = torn || part != value[0];
    went_back = went_back || value[0] <= newest;
    newest = value[0];
  }
  writer.join();
  EXPECT_FALSE(torn);
  EXPECT_FALSE(went_back);
}

}  // namespace swiftlet::runtime::latest_value_test

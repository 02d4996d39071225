#include "swiftlet/services/px4/px4_clock.hpp"

#include <algorithm>
#include <cstdlib>

#include <gtest/gtest.h>

#include "swiftlet/math/random.hpp"

namespace swiftlet::px4::px4_clock_test {

constexpr std::int64_t kPeriodNs = 10'000'000;
constexpr std::int64_t kStart = 1'000'000'000'000;

// GIVEN samples that arrive 2 to 8 ms late WHEN PX4's stamps are 150 ms behind THEN the stamps have PX4's intervals.
TEST(Px4Clock, RemovesTheJitterOfTheWay) {
  Px4Clock clock;
  math::RandomStream random(1, 1);
  double worst_ns = 0.0;
  std::int64_t last_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t true_ns = kStart + i * kPeriodNs;
    const auto late_ns = static_cast<std::int64_t>(2e6 + 6e6 * random.uniform());
    const auto stamp_us = static_cast<std::uint64_t>((true_ns - 150'000'000) / 1000);
    const std::int64_t stamp_ns = clock.to_host(stamp_us, true_ns + late_ns);
    EXPECT_LE(stamp_ns, true_ns + late_ns) << "not in the future";
    EXPECT_GT(stamp_ns, last_ns);
    last_ns = stamp_ns;
    if (i > 200) worst_ns = std::max(worst_ns, std::abs(static_cast<double>(stamp_ns - true_ns) - 2e6));
  }
  EXPECT_LT(worst_ns, 0.5e6);
  EXPECT_EQ(clock.steps(), 0);
}

TEST(Px4Clock, FollowsADrift) {
  Px4Clock clock;
  for (int i = 0; i < 3000; ++i) {  // at 0.98 of real time
    const std::int64_t true_ns = kStart + i * kPeriodNs;
    const auto stamp_us = static_cast<std::uint64_t>((kStart + i * kPeriodNs * 98 / 100) / 1000);
    const std::int64_t stamp_ns = clock.to_host(stamp_us, true_ns + 1'000'000);
    if (i <= 200) continue;
    ASSERT_NEAR(static_cast<double>(stamp_ns - true_ns), 0.0, 25e6) << i;
  }
  EXPECT_EQ(clock.steps(), 0);
}

// GIVEN a steady stream WHEN PX4's time synchronisation sets its stamps by 2 s THEN ours neither jump nor go back.
TEST(Px4Clock, AStepOfThePx4sStampsIsNotPassedOn) {
  Px4Clock clock;
  std::int64_t last_ns = kStart;
  for (int i = 1; i < 400; ++i) {
    const std::int64_t true_ns = kStart + i * kPeriodNs;
    const std::int64_t offset_ns = i < 200 ? -100'000'000 : 1'900'000'000;
    const std::int64_t stamp_ns =
        clock.to_host(static_cast<std::uint64_t>((true_ns + offset_ns) / 1000), true_ns);
    EXPECT_GT(stamp_ns, last_ns);
    EXPECT_LE(stamp_ns - last_ns, 2 * kPeriodNs);
    last_ns = stamp_ns;
  }
  EXPECT_LE(clock.steps(), 1);
}

// GIVEN a simulated PX4 WHEN its time stands still for 60 ms THEN the stamps are right again after five samples.
TEST(Px4Clock, AStandstillIsForgottenAtOnce) {
  Px4Clock clock;
  for (int i = 1; i < 400; ++i) {
    const std::int64_t px4_ns = kStart + i * kPeriodNs;
    const std::int64_t true_ns = px4_ns + (i < 200 ? 0 : 60'000'000);
    const std::int64_t stamp_ns = clock.to_host(static_cast<std::uint64_t>(px4_ns / 1000), true_ns);
    if (i >= 200 && i <= 206) continue;
    EXPECT_NEAR(static_cast<double>(true_ns - stamp_ns), 0.0, 1e6) << i;
  }
  EXPECT_EQ(clock.steps(), 1);
}

// GIVEN samples that queued up for 200 ms and then arrive at once THEN they keep their intervals.
TEST(Px4Clock, AQueueIsNoStepOfTheStamps) {
  Px4Clock clock;
  for (int i = 1; i < 400; ++i) {
    const std::int64_t true_ns = kStart + i * kPeriodNs;
    const std::int64_t arrived_ns =
        i > 200 && i < 220 ? kStart + 220 * kPeriodNs - 1'000'000 + i * 1000 : true_ns;
    const std::int64_t stamp_ns = clock.to_host(static_cast<std::uint64_t>(true_ns / 1000), arrived_ns);
    EXPECT_LE(stamp_ns, arrived_ns);
    if (i >= 200 && i <= 225) continue;
    EXPECT_NEAR(static_cast<double>(true_ns - stamp_ns), 0.0, 1e6) << i;
  }
  EXPECT_EQ(clock.steps(), 0);
}

}  // namespace swiftlet::px4::px4_clock_test

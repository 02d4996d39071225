// The periodic timer against the clock. Bounds are one-sided or generous for loaded
// machines.
#include <chrono>

#include <gtest/gtest.h>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::runtime::timing_test {

constexpr std::int64_t kMillisecond = 1'000'000;

TEST(PeriodicTimer, NeverTicksBeforeItsTime) {
  const std::int64_t start = monotonic_ns();
  PeriodicTimer timer(2 * kMillisecond, 1000 * kMillisecond);
  for (std::int64_t tick = 1; tick <= 50; ++tick) {
    timer.wait();
    EXPECT_GE(monotonic_ns() - start, tick * 2 * kMillisecond);
  }
}

TEST(PeriodicTimer, CatchesUpSmallDelays) {
  const std::int64_t start = monotonic_ns();
  PeriodicTimer timer(2 * kMillisecond, 10'000 * kMillisecond);
  timer.wait();
  while (monotonic_ns() - start < 20 * kMillisecond) {
  }
  for (int tick = 2; tick <= 9; ++tick) EXPECT_EQ(timer.wait(), 0);  // returns at once: the times have passed
  timer.wait();
  timer.wait();
  EXPECT_GE(monotonic_ns() - start, 22 * kMillisecond);  // the eleventh is on time again
}

TEST(PeriodicTimer, SkipsTicksThatAreTooLate) {
  const std::int64_t start = monotonic_ns();
  PeriodicTimer timer(2 * kMillisecond, 4 * kMillisecond);
  std::int64_t skipped_ns = timer.wait();  // 0, or more on a busy machine
  while (monotonic_ns() - start < 30 * kMillisecond + skipped_ns) {
  }
  const std::int64_t too_late = timer.wait();
  EXPECT_GE(too_late, 26 * kMillisecond);
  skipped_ns += too_late;
  timer.wait();
  EXPECT_GE(monotonic_ns() - start, 4 * kMillisecond + skipped_ns + 2 * kMillisecond);  // no burst
}

TEST(PeriodicTimer, KeepsItsPhase) {
  const std::int64_t origin = monotonic_ns() - 5 * kMillisecond;
  PeriodicTimer timer(2 * kMillisecond, 2 * kMillisecond, origin);
  EXPECT_EQ((timer.tick_ns() - origin) % (2 * kMillisecond), 0);
  EXPECT_GE(timer.tick_ns() - origin, 4 * kMillisecond);
  timer.wait();
  while (monotonic_ns() < timer.tick_ns() + 7 * kMillisecond) {
  }
  EXPECT_GT(timer.wait(), 0);
  EXPECT_EQ((timer.tick_ns() - origin) % (2 * kMillisecond), 0);
}

}  // namespace swiftlet::runtime::timing_test

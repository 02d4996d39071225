#include "swiftlet/services/dds/periodic_task.hpp"

#include <atomic>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"

namespace swiftlet::dds::periodic_task_test {

using namespace std::chrono_literals;

TEST(PeriodicTask, RunsRepeatedlyUntilDestroyed) {
  std::atomic<int> runs{0};
  {
    const PeriodicTask periodic_task(1ms, [&] { ++runs; });
    EXPECT_TRUE(swiftlet::tests::eventually([&] { return runs >= 3; }));
  }
  const int at_end = runs;
  std::atomic<int> later_runs{0};
  const PeriodicTask later(1ms, [&] { ++later_runs; });
  EXPECT_TRUE(swiftlet::tests::eventually([&] { return later_runs >= 3; }));
  EXPECT_EQ(runs, at_end);
}

TEST(PeriodicTask, DestructorDoesNotWaitForThePeriod) {
  const auto began = std::chrono::steady_clock::now();
  {
    const PeriodicTask periodic_task(10min, [] { ADD_FAILURE() << "ran before its period"; });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5min);
}

}  // namespace swiftlet::dds::periodic_task_test

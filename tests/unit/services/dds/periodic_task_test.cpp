#include "swiftlet/services/dds/periodic_task.hpp"

#include <atomic>
#include <chrono>

#include <gtest/gtest.h>

#include "tests/support/eventually.hpp"

namespace swiftlet::comms {
namespace {

using namespace std::chrono_literals;

TEST(PeriodicTask, LooksAgainAndAgainUntilItEnds) {
  std::atomic<int> looks{0};
  {
    const PeriodicTask periodic_task(1ms, [&] { ++looks; });
    EXPECT_TRUE(swiftlet::tests::eventually([&] { return looks >= 3; }));
  }
  const int at_end = looks;
  const PeriodicTask later(1ms, [] {});
  EXPECT_EQ(looks, at_end);
}

TEST(PeriodicTask, EndsWithoutWaitingForItsPeriod) {
  const auto began = std::chrono::steady_clock::now();
  {
    const PeriodicTask periodic_task(10min, [] { ADD_FAILURE() << "the period is not over"; });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - began, 5min);
}

}  // namespace
}  // namespace swiftlet::comms

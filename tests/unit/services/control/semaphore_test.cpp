#include "swiftlet/services/control/semaphore.hpp"

#include <chrono>
#include <thread>

#include <gtest/gtest.h>

namespace swiftlet::services::semaphore_test {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto kLong = 60s;  // longer than any test

TEST(Semaphore, APostBeforeTheWaitIsNotLost) {
  Semaphore semaphore;
  semaphore.post();
  const auto began = Clock::now();
  semaphore.wait_for(kLong);
  EXPECT_LT(Clock::now() - began, kLong / 2);
}

// Many posts wake one wait: the next wait lasts its full time.
TEST(Semaphore, PostsAreNotCounted) {
  Semaphore semaphore;
  for (int i = 0; i < 5; ++i) semaphore.post();
  semaphore.wait_for(kLong);
  const auto began = Clock::now();
  semaphore.wait_for(20ms);
  EXPECT_GE(Clock::now() - began, 20ms);
}

TEST(Semaphore, PostSynchronisesWithTheWait) {
  Semaphore there;
  Semaphore back;
  int value = 0;
  bool in_order = true;
  constexpr int kRounds = 2000;
  std::thread other([&] {
    for (int i = 0; i < kRounds; ++i) {
      there.wait_for(kLong);
      in_order = in_order && value == 2 * i + 1;
      ++value;
      back.post();
    }
  });
  for (int i = 0; i < kRounds; ++i) {
    ++value;
    there.post();
    back.wait_for(kLong);
  }
  other.join();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(value, 2 * kRounds);
}

}  // namespace swiftlet::services::semaphore_test

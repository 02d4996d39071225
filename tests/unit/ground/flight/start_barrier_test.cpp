#include "swiftlet/ground/flight/start_barrier.hpp"

#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::start_barrier_test {

using namespace std::chrono_literals;

constexpr auto kLong = 60s;  // longer than any test

TEST(StartBarrier, ReleasesAllWhenTheLastIsReady) {
  constexpr int kFlights = 4;
  StartBarrier barrier(kFlights);
  std::vector<char> began(kFlights, 0);
  std::vector<std::thread> flights;
  barrier.ready();
  EXPECT_FALSE(barrier.wait_for_all(1ms)) << "three are not ready";
  for (std::size_t i = 1; i < kFlights; ++i) {
    flights.emplace_back([&, i] {
      barrier.ready();
      began[i] = barrier.wait_for_all(kLong) ? 1 : 0;
    });
  }
  began[0] = barrier.wait_for_all(kLong) ? 1 : 0;
  for (std::thread& flight : flights) flight.join();
  EXPECT_EQ(began, std::vector<char>(kFlights, 1));
  EXPECT_FALSE(barrier.failure().has_value());
}

TEST(StartBarrier, ReleasesNoneAfterAFailure) {
  StartBarrier barrier(2);
  barrier.ready();
  std::thread other([&] { barrier.fail("kl2: no pose"); });
  EXPECT_FALSE(barrier.wait_for_all(kLong)) << "must return at the failure";
  other.join();
  barrier.fail("kl1: another one");
  EXPECT_EQ(barrier.failure(), "kl2: no pose") << "the first failure counts";
  barrier.ready();
  EXPECT_FALSE(barrier.wait_for_all(1ms)) << "although both are ready";
}

}  // namespace swiftlet::ground::start_barrier_test

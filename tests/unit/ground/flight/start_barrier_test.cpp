#include "swiftlet/ground/flight/start_barrier.hpp"

#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;

constexpr auto kLong = 60s;  // as long as no test takes

TEST(StartBarrier, AllBeginWhenTheLastIsReady) {
  constexpr int kFlights = 4;
  StartBarrier together(kFlights);
  std::vector<char> began(kFlights, 0);
  std::vector<std::thread> flights;
  together.ready();
  EXPECT_FALSE(together.wait_for_all(1ms)) << "three are missing";
  for (std::size_t i = 1; i < kFlights; ++i) {
    flights.emplace_back([&, i] {
      together.ready();
      began[i] = together.wait_for_all(kLong) ? 1 : 0;
    });
  }
  began[0] = together.wait_for_all(kLong) ? 1 : 0;
  for (std::thread& flight : flights) flight.join();
  EXPECT_EQ(began, std::vector<char>(kFlights, 1));
  EXPECT_FALSE(together.failure().has_value());
}

TEST(StartBarrier, NoneBeginsOnceOneHasFailed) {
  StartBarrier together(2);
  together.ready();
  std::thread other([&] { together.fail("kl2: no pose"); });
  EXPECT_FALSE(together.wait_for_all(kLong)) << "and does not wait for it";
  other.join();
  together.fail("kl1: another one");
  EXPECT_EQ(together.failure(), "kl2: no pose") << "the first";
  together.ready();
  EXPECT_FALSE(together.wait_for_all(1ms)) << "ready as they are now";
}

}  // namespace
}  // namespace swiftlet::ground

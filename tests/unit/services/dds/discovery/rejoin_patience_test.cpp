#include "swiftlet/services/dds/discovery/rejoin_patience.hpp"

#include <gtest/gtest.h>

namespace swiftlet::comms::rejoin_patience_test {

using namespace std::chrono_literals;

constexpr RejoinPatience::Time kStart = RejoinPatience::Time{} + 1h;

TEST(RejoinPatience, DoublesWithEachRejoin) {
  RejoinPatience patience(0.0);
  RejoinPatience::Time now = kStart;
  for (const auto expected : {1000ms, 2000ms, 4000ms, 8000ms, 16000ms, 16000ms}) {
    EXPECT_EQ(patience.at(now), expected);
    now += expected;
    patience.rejoined(now);
  }
}

TEST(RejoinPatience, BeginsAgainAfterAQuietTime) {
  RejoinPatience patience(0.0);
  patience.rejoined(kStart);
  patience.rejoined(kStart + 2s);
  EXPECT_EQ(patience.at(kStart + 62s), 4000ms);
  EXPECT_EQ(patience.at(kStart + 63s), 1000ms);
  patience.rejoined(kStart + 63s);
  EXPECT_EQ(patience.at(kStart + 63s), 2000ms);
}

TEST(RejoinPatience, DiffersBetweenProcessesAfterTheFirst) {
  RejoinPatience patience(1.0);
  EXPECT_EQ(patience.at(kStart), 1000ms);
  patience.rejoined(kStart);
  EXPECT_EQ(patience.at(kStart), 3000ms);
}

}  // namespace swiftlet::comms::rejoin_patience_test

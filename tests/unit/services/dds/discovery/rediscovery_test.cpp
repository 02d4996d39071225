#include "swiftlet/services/dds/discovery/rediscovery.hpp"

#include <gtest/gtest.h>

namespace swiftlet::dds::rediscovery_test {

using namespace std::chrono_literals;

constexpr RejoinPatience::Time kStart = RejoinPatience::Time{} + 1h;

TEST(PeerEndpoints, AreMissingIfAKindDoesNotReturn) {
  const unsigned both = PeerEndpoints::kWriter | PeerEndpoints::kReader;
  for (const unsigned known : {0U, 1U, 2U}) {
    PeerEndpoints endpoints{kStart, known, 0};
    EXPECT_FALSE(endpoints.are_missing(kStart + 1min, 1000ms)) << "it may have no others";
    endpoints.before = both;
    EXPECT_FALSE(endpoints.are_missing(kStart + 900ms, 1000ms));
    EXPECT_TRUE(endpoints.are_missing(kStart + 1100ms, 1000ms));
    endpoints.known = both;
    EXPECT_FALSE(endpoints.are_missing(kStart + 1min, 1000ms));
  }
  EXPECT_FALSE((PeerEndpoints{kStart, both, PeerEndpoints::kReader}.are_missing(kStart + 1min, 1000ms)));
}

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

}  // namespace swiftlet::dds::rediscovery_test

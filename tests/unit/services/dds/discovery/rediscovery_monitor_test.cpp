#include "swiftlet/services/dds/discovery/rediscovery_monitor.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace swiftlet::comms {
namespace {

using namespace std::chrono_literals;

using Peers = RediscoveryMonitor<int>;

class ReunionsTest : public testing::Test {
 protected:
  ReunionsTest() {
    reunions_.came(1, start_);
    reunions_.has(1, Peers::kWriter);
    reunions_.has(1, Peers::kReader);
  }
  bool failed_after(std::chrono::milliseconds time) const { return reunions_.failed(start_ + time, 1000ms); }

  const Peers::Time start_ = std::chrono::steady_clock::now();
  Peers reunions_;
};

TEST_F(ReunionsTest, APeerIsNotMissedBeforeItIsBack) {
  reunions_.came(2, start_);
  EXPECT_FALSE(failed_after(1min)) << "it may have none";
  reunions_.lost(1);
  EXPECT_FALSE(failed_after(2min));
}

TEST_F(ReunionsTest, ItFailsWhenAKindOfEndpointStaysAway) {
  for (const auto kind : {Peers::kWriter, Peers::kReader}) {
    reunions_.lost(1);
    reunions_.came(1, start_);
    reunions_.has(1, kind);
    EXPECT_FALSE(failed_after(900ms));
    EXPECT_TRUE(failed_after(1100ms));
  }
  reunions_.clear();
  EXPECT_FALSE(failed_after(1100ms));
}

TEST_F(ReunionsTest, ItSucceedsWithAllKinds) {
  reunions_.lost(1);
  reunions_.came(1, start_);
  reunions_.has(1, Peers::kReader);
  reunions_.has(1, Peers::kWriter);
  EXPECT_FALSE(failed_after(1min));
}

TEST_F(ReunionsTest, OneThatIsLostAgainOrSaysGoodbyeIsNoLongerAwaited) {
  for (const bool goodbye : {false, true}) {
    reunions_.lost(1);
    reunions_.came(1, start_);
    EXPECT_TRUE(failed_after(1min));
    goodbye ? reunions_.gone(1) : reunions_.lost(1);
    EXPECT_FALSE(failed_after(1min));
  }
}

}  // namespace
}  // namespace swiftlet::comms

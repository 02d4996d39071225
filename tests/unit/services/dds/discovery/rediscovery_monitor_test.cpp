#include "swiftlet/services/dds/discovery/rediscovery_monitor.hpp"

#include <chrono>

#include <gtest/gtest.h>

namespace swiftlet::comms::rediscovery_monitor_test {

using namespace std::chrono_literals;

using Peers = RediscoveryMonitor<int>;

class RediscoveryMonitorTest : public testing::Test {
 protected:
  RediscoveryMonitorTest() {
    rediscovery_.came(1, start_);
    rediscovery_.has(1, Peers::kWriter);
    rediscovery_.has(1, Peers::kReader);
  }
  bool failed_after(std::chrono::milliseconds time) const {
    return rediscovery_.failed(start_ + time, 1000ms);
  }

  const Peers::Time start_ = std::chrono::steady_clock::now();
  Peers rediscovery_;
};

TEST_F(RediscoveryMonitorTest, IgnoresALostPeerUntilItReturns) {
  rediscovery_.came(2, start_);
  EXPECT_FALSE(failed_after(1min)) << "it may have no endpoints";
  rediscovery_.lost(1);
  EXPECT_FALSE(failed_after(2min));
}

TEST_F(RediscoveryMonitorTest, FailsWhenAKindOfEndpointDoesNotReturn) {
  for (const auto kind : {Peers::kWriter, Peers::kReader}) {
    rediscovery_.lost(1);
    rediscovery_.came(1, start_);
    rediscovery_.has(1, kind);
    EXPECT_FALSE(failed_after(900ms));
    EXPECT_TRUE(failed_after(1100ms));
  }
  rediscovery_.clear();
  EXPECT_FALSE(failed_after(1100ms));
}

TEST_F(RediscoveryMonitorTest, SucceedsWhenAllEndpointKindsReturn) {
  rediscovery_.lost(1);
  rediscovery_.came(1, start_);
  rediscovery_.has(1, Peers::kReader);
  rediscovery_.has(1, Peers::kWriter);
  EXPECT_FALSE(failed_after(1min));
}

TEST_F(RediscoveryMonitorTest, StopsWaitingForALostOrDepartedPeer) {
  for (const bool goodbye : {false, true}) {
    rediscovery_.lost(1);
    rediscovery_.came(1, start_);
    EXPECT_TRUE(failed_after(1min));
    goodbye ? rediscovery_.gone(1) : rediscovery_.lost(1);
    EXPECT_FALSE(failed_after(1min));
  }
}

// A process that is started again is another peer.
TEST_F(RediscoveryMonitorTest, ForgetsPeersThatNeverReturn) {
  for (int peer = 2; peer < 5000; ++peer) {
    rediscovery_.came(peer, start_);
    rediscovery_.has(peer, Peers::kWriter);
    rediscovery_.lost(peer);
  }
  EXPECT_LE(rediscovery_.size(), Peers::kMostLost + 1);
  rediscovery_.came(4999, start_);
  EXPECT_TRUE(failed_after(1min)) << "one of the last ones that were lost";
}

}  // namespace swiftlet::comms::rediscovery_monitor_test

#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <gtest/gtest.h>

namespace swiftlet::comms {
namespace {

// RTPS 2.5, 9.6.1.1: 7400 + 250 domain, + 0 for multicast of discovery, + 10 + 2 n for discovery of process n; the data
// ports are the odd ones.
TEST(DiscoveryPort, IsThatOfTheRtpsStandard) {
  EXPECT_TRUE(is_discovery_port(0, 7400));
  EXPECT_FALSE(is_discovery_port(0, 7401)) << "multicast of data";
  EXPECT_TRUE(is_discovery_port(0, 7410));
  EXPECT_FALSE(is_discovery_port(0, 7411));
  EXPECT_TRUE(is_discovery_port(0, 7412));
  EXPECT_FALSE(is_discovery_port(0, 7650)) << "of domain 1";
  EXPECT_TRUE(is_discovery_port(1, 7650));
  EXPECT_FALSE(is_discovery_port(0, 49'152)) << "a port of its own of a reader";
}

}  // namespace
}  // namespace swiftlet::comms

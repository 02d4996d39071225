#include "swiftlet/services/dds/discovery/discovery_servers.hpp"

#include <string>

#include <gtest/gtest.h>

namespace swiftlet::comms::discovery_servers_test {

TEST(DiscoveryServers, AreNumberedByTheirPlace) {
  const auto servers = parse_discovery_servers("lab1;;10.0.0.7:11900");
  ASSERT_EQ(servers.size(), 2U);
  EXPECT_EQ(servers[0].number, 0);
  EXPECT_EQ(servers[0].address.host, "lab1");
  EXPECT_EQ(servers[0].address.port, 11811);
  EXPECT_EQ(servers[1].number, 2);
  EXPECT_EQ(servers[1].address.host, "10.0.0.7");
  EXPECT_EQ(servers[1].address.port, 11900);
}

TEST(DiscoveryServers, AreRefusedIfOneIsMalformed) {
  for (const char* list : {"lab1", "lab1:11811", ";lab2", "lab1;lab2:1"})
    EXPECT_EQ(fault_of_discovery_servers(list), "") << list;
  for (const char* list : {"", ";", "lab1:0", "lab1;lab2:x", "lab1,lab2"})
    EXPECT_NE(fault_of_discovery_servers(list), "") << list;
  EXPECT_NE(fault_of_discovery_servers(std::string(256, ';') + "lab1"), "");
}

}  // namespace swiftlet::comms::discovery_servers_test

#include "swiftlet/services/dds/discovery/address_watch.hpp"

#include <gtest/gtest.h>

namespace swiftlet::dds::address_watch_test {

const io::Interface kEth0{"eth0", "10.0.0.1"};
const io::Interface kEth0Later{"eth0", "10.0.0.2"};
const io::Interface kWlan0{"wlan0", "10.0.1.1"};
const io::Interface kLo{"lo", "127.0.0.1", true};

TEST(AddressWatch, SaysWhatHasChangedOnce) {
  AddressWatch watch;
  const NetworkSettings any;
  EXPECT_EQ(watch.change({kLo}, any),
            "this host has no IPv4 address but that of the loopback interface: others reach it when it has "
            "one; IPv6 is "
            "not used");
  EXPECT_EQ(watch.change({}, any), std::nullopt);
  EXPECT_EQ(watch.change({kLo, kEth0, kWlan0}, any),
            "the addresses of this host are 10.0.0.1 of eth0, 10.0.1.1 of wlan0 now, and announced");
  EXPECT_EQ(watch.change({kWlan0, kEth0}, any), std::nullopt);
  EXPECT_EQ(watch.change({}, any),
            "this host has no IPv4 address but that of the loopback interface now: others reach it when it "
            "has one");

  AddressWatch in_a_network;
  EXPECT_EQ(in_a_network.change({kEth0}, any), std::nullopt);
}

// What keeps to the addresses of its start does not heal.
TEST(AddressWatch, SaysWhoMustBeRestarted) {
  NetworkSettings one_interface;
  one_interface.interfaces = {"eth0"};
  NetworkSettings server;
  server.discovery_servers = "lab1";
  for (const NetworkSettings& network : {one_interface, server}) {
    AddressWatch watch;
    watch.change({kEth0}, network);
    const std::string said = watch.change({kEth0Later}, network).value_or("");
    EXPECT_NE(said.find("10.0.0.2 of eth0 now; "), std::string::npos) << said;
    EXPECT_NE(said.find(": restart this process if they have gone"), std::string::npos) << said;
  }
}

}  // namespace swiftlet::dds::address_watch_test

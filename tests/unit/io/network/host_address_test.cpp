#include "swiftlet/io/network/host_address.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/interfaces.hpp"

namespace swiftlet::io::host_address_test {

TEST(HostAddress, IsANameOrAddressWithOrWithoutPort) {
  for (const char* text : {"lab2", "lab-2.example.org", "10.0.0.7", "10.0.0.7:7412", "lab2:1", "lab2:65535"})
    EXPECT_EQ(fault_of_host_address(text), "") << text;
  EXPECT_EQ(parse_host_address("lab2:7412").host, "lab2");
  EXPECT_EQ(parse_host_address("lab2:7412").port, 7412);
  EXPECT_EQ(parse_host_address("10.0.0.7").host, "10.0.0.7");
  EXPECT_EQ(parse_host_address("10.0.0.7").port, 0);
}

TEST(HostAddress, IsRefusedOtherwise) {
  for (const char* text : {"", ":7412", "lab2:", "lab2:0", "lab2:65536", "lab2:-1", "lab2:74x", "lab 2",
                           "10.0.0", "10.0.0.256", "1.2.3.4.5", "a,b", "a:1:2", "7", "../lab"})
    EXPECT_EQ(fault_of_host_address(text),
              "is '" + std::string(text) +
                  "', must be HOST or HOST:PORT, a name or IPv4 address and a port from 1 to 65535");
}

TEST(HostAddress, IsLookedUp) {
  EXPECT_EQ(ipv4_addresses_of("localhost"), std::vector<std::string>{"127.0.0.1"});
  EXPECT_EQ(ipv4_addresses_of("10.0.0.7"), std::vector<std::string>{"10.0.0.7"});
  try {
    ipv4_addresses_of("no-such-host.invalid");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(std::string(error.what()).rfind("host 'no-such-host.invalid' is unknown: ", 0), 0U)
        << error.what();
  }
}

TEST(Interfaces, AreGivenByNameOrAddress) {
  EXPECT_EQ(addresses_of_interfaces({"lo"}), std::vector<std::string>{"127.0.0.1"});
  EXPECT_EQ(addresses_of_interfaces({"127.0.0.1"}), std::vector<std::string>{"127.0.0.1"});
  const std::string fault = "is 'wlan9', must be an interface that is up, by name or IPv4 address: ";
  EXPECT_EQ(fault_of_interface("wlan9"), fault + interfaces_text(false));
  EXPECT_THROW(addresses_of_interfaces({"lo", "wlan9"}), std::runtime_error);
}

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

}  // namespace swiftlet::io::host_address_test

// Hosts on a switch, and behind routers that forward no multicast: who reaches whom.
#include <arpa/inet.h>
#include <chrono>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "tests/support/network_namespace.hpp"

namespace swiftlet::tests {
namespace {

using Layout = HostNetwork::Layout;

constexpr const char* kGroup = "239.255.0.1";
constexpr std::uint16_t kPort = 7400;

sockaddr_in socket_address(const std::string& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(kPort);
  result.sin_addr.s_addr = inet_addr(address.c_str());
  return result;
}

// True if a datagram from one host to this address arrives at the other host within a second.
bool arrives(const HostNetwork& network, int from, int at, const std::string& address) {
  int receiver = -1;
  {
    const HostNetwork::Inside inside(network, at);
    receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in any = socket_address("0.0.0.0");
    bind(receiver, reinterpret_cast<const sockaddr*>(&any), sizeof any);
    const ip_mreq group{{inet_addr(kGroup)}, {inet_addr(network.address(at).c_str())}};
    setsockopt(receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
    const timeval patience{1, 0};
    setsockopt(receiver, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  {
    const HostNetwork::Inside inside(network, from);
    const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in to = socket_address(address);
    sendto(sender, "x", 1, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
    close(sender);
  }
  char byte = 0;
  const bool received = recv(receiver, &byte, 1, 0) == 1;
  close(receiver);
  return received;
}

TEST(HostNetwork, CarriesMulticastOverASwitchButNotThroughARouter) {
  if (const std::string why = HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  {
    const HostNetwork network(Layout::kSwitch, 2);
    EXPECT_TRUE(arrives(network, 0, 1, network.address(1)));
    EXPECT_TRUE(arrives(network, 0, 1, kGroup));
  }
  const HostNetwork network(Layout::kRouter, 2);
  EXPECT_TRUE(arrives(network, 0, 1, network.address(1)));
  EXPECT_FALSE(arrives(network, 0, 1, kGroup));
  network.run(0, "ip link set eth0 down");
  EXPECT_FALSE(arrives(network, 0, 1, network.address(1)));
}

}  // namespace
}  // namespace swiftlet::tests

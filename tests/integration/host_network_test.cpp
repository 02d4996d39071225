// The hosts of the tests of networks: what reaches whom over a switch, and through a router;
// and what a program says in one without interfaces.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/network/sockets.hpp"
#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

constexpr const char* kGroup = "239.255.0.1";
constexpr std::uint16_t kDataPort = 7400;

// True if a datagram from one host to this address arrives at the other host within this time.
bool arrives(const HostNetwork& network, int from, int at, const std::string& address, timeval patience) {
  int receiver = -1;
  {
    const HostNetwork::Inside inside(network, at);
    receiver = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in any = io::socket_address("", kDataPort);
    EXPECT_EQ(bind(receiver, reinterpret_cast<const sockaddr*>(&any), sizeof any), 0);
    const ip_mreq group{{inet_addr(kGroup)}, {inet_addr(network.address(at).c_str())}};
    setsockopt(receiver, IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group);
    setsockopt(receiver, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  {
    const HostNetwork::Inside inside(network, from);
    const int sender = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in to = io::socket_address(address, kDataPort);
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
  constexpr timeval kPatience{60, 0}, kMoment{0, 200'000};
  {
    const HostNetwork network(HostNetwork::Layout::kSwitch, 2);
    EXPECT_TRUE(arrives(network, 0, 1, network.address(1), kPatience));
    EXPECT_TRUE(arrives(network, 0, 1, kGroup, kPatience));
  }
  const HostNetwork network(HostNetwork::Layout::kRouter, 2);
  EXPECT_TRUE(arrives(network, 0, 1, network.address(1), kPatience));
  EXPECT_FALSE(arrives(network, 0, 1, kGroup, kMoment));
  network.run(0, "ip link set eth0 down");
  EXPECT_FALSE(arrives(network, 0, 1, network.address(1), kMoment));
}

// As in a network namespace that was just made.
TEST(HostNetwork, WithoutItsLoopbackInterfaceIsNoFullDomain) {
  if (const std::string why = HostNetwork::why_unavailable(); !why.empty()) GTEST_SKIP() << why;
  const HostNetwork network(HostNetwork::Layout::kSwitch, 1);
  network.run(0, "ip link set lo down");
  const HostNetwork::Inside inside(network, 0);
  const ProgramResult list = run_program("swiftlet", {"list"}, TemporaryFolder().path(), kStuck);
  EXPECT_EQ(list.exit_code, 1);
  EXPECT_NE(list.errors.find("interface is '127.0.0.1', must be an interface that is up"), std::string::npos)
      << list.errors;
}

}  // namespace
}  // namespace swiftlet::tests

// How many processes of a host discover each other. Occupied ports stand in for processes.
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"

#include <arpa/inet.h>
#include <memory>
#include <netinet/in.h>
#include <optional>
#include <stdexcept>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/dds/node_settings.hpp"

namespace swiftlet::dds::discovery_ports_test {

using fixtures::settings;
using swiftlet::tests::Inbox;

// Occupies the first ports of a domain.
class TakenPorts {
 public:
  TakenPorts(int domain, std::uint32_t count) {
    const DiscoveryPorts ports = discovery_ports(domain);
    for (std::uint32_t i = 0; i < count; ++i) take(ports.first + i * ports.gap);
  }
  ~TakenPorts() {
    for (const int socket : sockets_) ::close(socket);
  }
  TakenPorts(const TakenPorts&) = delete;
  TakenPorts& operator=(const TakenPorts&) = delete;

 private:
  void take(std::uint32_t port) {
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    const sockaddr_in address = io::socket_address("127.0.0.1", static_cast<int>(port));
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      throw std::runtime_error("port " + std::to_string(port) + " is taken already");
    sockets_.push_back(socket);
  }
  std::vector<int> sockets_;
};

TEST(DiscoveryPorts, DoNotOverlapBetweenDomains) {
  for (int domain = 0; domain < 232; ++domain) {
    const DiscoveryPorts ports = discovery_ports(domain);
    ASSERT_EQ(ports.count, 120U) << domain;
    ASSERT_EQ(ports.first, 7410U + 250U * static_cast<std::uint32_t>(domain));
    ASSERT_LT(ports.last() + 1, discovery_ports(domain + 1).first - 10) << domain;
  }
  const DiscoveryPorts last = discovery_ports(232);
  EXPECT_EQ(last.count, 63U);
  EXPECT_EQ(last.last() + 1, 65535U);
}

// The first node takes the first free port, the last one the last port of the domain.
TEST(DiscoveryPorts, LetFirstAndLastProcessDiscoverEachOther) {
  const DomainLock lock;
  const std::uint32_t count = discovery_ports(lock.domain()).count;
  const TakenPorts all_but_last(lock.domain(), count - 2);
  Inbox<std::string> found_by_first;
  Inbox<std::string> found_by_last;
  Node first(settings(lock, "first"));
  first.on_peer([&](const PeerEvent& peer) { found_by_first.put(peer.name); });
  Node last(settings(lock, "last"));
  last.on_peer([&](const PeerEvent& peer) { found_by_last.put(peer.name); });

  ASSERT_TRUE(found_by_first.wait_for_count(1));
  ASSERT_TRUE(found_by_last.wait_for_count(1));
  EXPECT_EQ(found_by_first.items()[0], "last");
  EXPECT_EQ(found_by_last.items()[0], "first");
}

// GIVEN a node on the last port WHEN one joins on the first port and announces itself to few ports
TEST(DiscoveryPorts, LetAHigherPortDiscoverALaterLowerOne) {
  const DomainLock lock;
  const DiscoveryPorts ports = discovery_ports(lock.domain());
  std::optional<TakenPorts> all_but_last(std::in_place, lock.domain(), ports.count - 1);
  Inbox<std::string> found_by_high;
  Inbox<std::string> found_by_low;
  Node high(settings(lock, "high"));
  all_but_last.reset();
  high.on_peer([&](const PeerEvent& peer) { found_by_high.put(peer.name); });
  Node low(settings(lock, "low"));
  low.on_peer([&](const PeerEvent& peer) { found_by_low.put(peer.name); });

  ASSERT_LT(announced_ports(ports, 0), ports.count);
  EXPECT_TRUE(found_by_low.wait_for_count(1));
  EXPECT_TRUE(found_by_high.wait_for_count(1));
}

TEST(DiscoveryPorts, AreAnnouncedToFromAllHigherPorts) {
  const DiscoveryPorts ports = discovery_ports(0);
  for (std::uint32_t own = 0; own < ports.count; ++own) ASSERT_GT(announced_ports(ports, own), own);
  EXPECT_EQ(announced_ports(ports, 0), 17U);
  EXPECT_EQ(announced_ports(ports, ports.count - 1), ports.count);
}

TEST(DiscoveryPorts, AreTakenInTheirOrder) {
  const DomainLock lock;
  const TakenPorts three(lock.domain(), 3);
  EXPECT_EQ(free_discovery_port(lock.domain(), "127.0.0.1"), 3U);
  const auto guard = std::make_shared<rtps::DatagramGuard>();
  const ParticipantSession session(settings(lock, "fourth"), {}, guard, nullptr);
  EXPECT_EQ(discovery_ports(lock.domain()).index_of(guard->discovery_port()), 3U);
  EXPECT_EQ(free_discovery_port(lock.domain(), "127.0.0.1"), 4U);
}

TEST(DiscoveryPorts, HaveNumbers) {
  const DiscoveryPorts ports = discovery_ports(0);
  EXPECT_EQ(ports.index_of(7410), 0U);
  EXPECT_EQ(ports.index_of(7414), 2U);
  for (const std::uint32_t other : {7400U, 7411U, 7650U}) EXPECT_FALSE(ports.index_of(other)) << other;
}

TEST(DiscoveryPorts, FullDomainIsRefused) {
  const DomainLock lock;
  const DiscoveryPorts ports = discovery_ports(lock.domain());
  const TakenPorts all(lock.domain(), ports.count);
  try {
    const Node node(settings(lock, "one too many"));
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), "DDS domain " + std::to_string(lock.domain()) +
                                " is full: all of its 120 ports for discovery on this host, UDP " +
                                std::to_string(ports.first) + " to " + std::to_string(ports.last()) +
                                ", are taken; choose another with --domain");
  }
}

// Domain 232 has fewer than 120 ports below the end of the UDP range.
// More often than it has ports, while another participant of the process stays.
TEST(DiscoveryPorts, LastDomainCanBeJoinedAgainAndAgain) {
  const DomainLock lock;
  const Node stays(settings(lock, "stays"));
  NodeSettings last = settings(lock, "here");
  last.domain = 232;
  for (std::uint32_t i = 0; i <= discovery_ports(last.domain).count; ++i) ASSERT_NO_THROW(Node node(last));
}

}  // namespace swiftlet::dds::discovery_ports_test

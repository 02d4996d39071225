#include "swiftlet/services/dds/participant_qos.hpp"

#include <array>
#include <chrono>
#include <cstdint>
#include <netinet/in.h>
#include <optional>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/dds/participant_session.hpp"
#include "tests/support/eventually.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::dds::fixtures::participant_qos_test {

using swiftlet::tests::eventually;
using swiftlet::tests::Inbox;

// A UDP port that is taken.
class TakenPort {
 public:
  explicit TakenPort(std::uint32_t port) {
    const sockaddr_in address = io::socket_address("", static_cast<int>(port));
    EXPECT_EQ(::bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0) << port;
  }
  ~TakenPort() { ::close(socket_); }
  TakenPort(const TakenPort&) = delete;
  TakenPort& operator=(const TakenPort&) = delete;

  bool has_received() const {
    std::array<char, 1> data{};
    return ::recv(socket_, data.data(), data.size(), MSG_DONTWAIT) >= 0;
  }

 private:
  const int socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

// A server of Fast DDS may end that takes in two changes of a participant at once: of which the first is that it joins.
TEST(ParticipantSession, WaitsBeforeItChangesWhatItAnnouncedFirst) {
  const DomainLock lock;
  NodeSettings settings;
  settings.name = "client";
  settings.domain = lock.domain();
  settings.open_network = true;
  settings.network.discovery_servers = "127.0.0.1:11811";
  const auto began = std::chrono::steady_clock::now();
  const ParticipantSession session(settings, {}, guard_of(settings), nullptr);
  EXPECT_GE(session.next_announcement(), began + kAnnouncementSpacing);
  settings.network.discovery_servers.clear();
  const ParticipantSession without(settings, {}, guard_of(settings), nullptr);
  EXPECT_LE(without.next_announcement(), std::chrono::steady_clock::now());
}

// GIVEN a host on which the first ports for samples are taken WHEN a process announces a change, as a source does, and
// subscribes then THEN samples reach it, and nothing is sent to the ports that others have taken.
TEST(SetNetwork, AnnouncesTheOwnPortAlsoAfterAChange) {
  const DomainLock lock;
  NodeSettings settings;
  settings.domain = lock.domain();
  settings.open_network = true;
  settings.network.peers = {"127.0.0.1"};
  const DiscoveryPorts ports = discovery_ports(settings.domain);
  const TakenPort first(ports.first + 1);
  const TakenPort second(ports.first + ports.gap + 1);

  settings.name = "control";
  Node control(settings);
  settings.name = "plant";
  settings.source_of = "imu";
  Node plant(settings);
  EXPECT_EQ(plant.become_source(), std::nullopt);
  Inbox<std::uint64_t> received;
  const auto subscription = plant.subscribe<messages::msg::ActuatorCommand>(
      messages::topics::kActuatorCommand,
      [&](const auto& command) { received.put(command.imu_sequence_number()); });
  auto commands = control.publish(messages::topics::kActuatorCommand);
  ASSERT_TRUE(eventually([&] { return commands.matched() == 1 && subscription.matched() == 1; }));
  auto command = messages::fixtures::example<messages::msg::ActuatorCommand>();
  command.imu_sequence_number(7);
  commands.publish(command);

  ASSERT_TRUE(received.wait_for_count(1));
  EXPECT_EQ(received.items().front(), 7U);
  EXPECT_FALSE(first.has_received());
  EXPECT_FALSE(second.has_received());
}

// As they may come from the environment, which no option has checked.
TEST(SetNetwork, RefusesMalformedPeers) {
  NodeSettings settings;
  settings.name = "plant";
  settings.network.peers = {"lab2:0"};
  EXPECT_THROW(Node{settings}, io::ConfigError);
}

}  // namespace swiftlet::dds::fixtures::participant_qos_test

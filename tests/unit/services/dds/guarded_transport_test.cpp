#include "swiftlet/services/dds/guarded_transport.hpp"

#include <arpa/inet.h>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <netinet/in.h>
#include <optional>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/io/network/sockets.hpp"
#include "tests/support/rtps_message.hpp"

namespace swiftlet::dds::guarded_transport_test {

namespace transport = eprosima::fastdds::rtps;

// A socket of the loopback interface.
class Receiver {
 public:
  Receiver() {
    socklen_t size = sizeof address_;
    auto* const address = reinterpret_cast<sockaddr*>(&address_);
    if (::bind(socket_, address, size) != 0 || ::getsockname(socket_, address, &size) != 0)
      throw std::runtime_error("no socket");
  }
  ~Receiver() { ::close(socket_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  fastrtps::Locator_t locator() const {
    fastrtps::Locator_t locator;
    fastrtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, "127.0.0.1", ::ntohs(address_.sin_port), locator);
    return locator;
  }
  // What has come over the loopback interface, which loses and delays nothing.
  int received() const {
    int count = 0;
    std::array<char, 256> bytes{};
    while (::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT) >= 0) ++count;
    return count;
  }

 private:
  const int socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address_ = io::socket_address("127.0.0.1", 0);
};

// As Fast DDS 3 uses it, or as 2.9 does, which has no other form.
template <class Transport>
auto transform(const Transport& transport, const fastrtps::Locator_t& announced, fastrtps::Locator_t& used,
               int) -> decltype(transport.transform_remote_locator(announced, used, true, true)) {
  return transport.transform_remote_locator(announced, used, true, true);
}
template <class Transport>
auto transform(const Transport& transport, const fastrtps::Locator_t& announced, fastrtps::Locator_t& used,
               long) -> decltype(transport.transform_remote_locator(announced, used)) {
  return transport.transform_remote_locator(announced, used);
}

// A chain of transports, and a channel that it opened for one place.
class Chain {
 public:
  Chain(std::shared_ptr<rtps::DatagramGuard> guard, std::optional<int> domain,
        const fastrtps::Locator_t& first) {
    transport::UDPv4TransportDescriptor udp;
    udp.interfaceWhiteList = {"127.0.0.1"};
    chain_.reset(guarded(udp, std::move(guard), domain)->create_transport());
    if (!chain_->init() || !open(first)) throw std::runtime_error("no transport");
  }
  bool open(const fastrtps::Locator_t& place) { return chain_->OpenOutputChannel(channels_, place); }
  std::size_t channels() const { return channels_.size(); }
  // Where a process of this address is reached; port 0: nowhere.
  fastrtps::Locator_t reached(const fastrtps::Locator_t& announced) const {
    fastrtps::Locator_t used;
    if (!transform(*chain_, announced, used, 0)) used.port = 0;
    return used;
  }
  void send(std::vector<fastrtps::Locator_t> places) {
    const std::vector<fastrtps::octet> datagram(100);
    for (auto& channel : channels_) {
      fastrtps::Locators first(places.begin());
      fastrtps::Locators last(places.end());
      dds::send(*channel, datagram,
                {&first, &last, std::chrono::steady_clock::now() + std::chrono::seconds(1)});
    }
  }

 private:
  std::unique_ptr<transport::TransportInterface> chain_;
  transport::SendResourceList channels_;
};

// Fast DDS fails an assertion for a place for which no channel was opened.
TEST(GuardedTransport, OpensThePlacesToWhichItSends) {
  const Receiver first, other;
  Chain chain(std::make_shared<rtps::DatagramGuard>(), std::nullopt, first.locator());
  chain.send({first.locator(), other.locator()});
  EXPECT_EQ(first.received(), 1);
  EXPECT_EQ(other.received(), 1);
  ASSERT_TRUE(chain.open(other.locator()));
  EXPECT_EQ(chain.channels(), 1U) << "sent twice otherwise";
  chain.send({first.locator(), other.locator()});
  EXPECT_EQ(first.received(), 1);
  EXPECT_EQ(other.received(), 1);
}

// As ROS 2 does by default, which uses all interfaces but that of the loopback.
TEST(GuardedTransport, ReachesProcessesOfThisHostThatAnnounceAnotherInterface) {
  const Receiver receiver;
  const Chain chain(std::make_shared<rtps::DatagramGuard>(), 0, receiver.locator());
  for (const io::Interface& own : io::interfaces_up()) {
    fastrtps::Locator_t announced = receiver.locator();
    fastrtps::IPLocator::setIPv4(announced, own.address);
    EXPECT_EQ(chain.reached(announced), receiver.locator()) << own.address;
  }
}

TEST(GuardedTransport, SendsToWhereAHostIsHeardNow) {
  const Receiver receiver;
  fastrtps::Locator_t before = receiver.locator();
  fastrtps::IPLocator::setIPv4(before, "10.1.2.3");
  auto guard = std::make_shared<rtps::DatagramGuard>();
  Chain chain(guard, 0, before);
  tests::ByteWriter parameters = tests::participant_parameters(tests::kAlice);
  parameters.parameter(
      0x0031, tests::ByteWriter().u32(1).u32(before.port).zeros(12).bytes(tests::Bytes{10, 1, 2, 3}));
  const tests::Bytes announcement = tests::announcement(tests::kAlice, parameters).bytes();
  for (const std::int64_t now_ns : {std::int64_t{1'000'000'000}, std::int64_t{2'500'000'000}})
    EXPECT_EQ(
        guard->admit(announcement.data(), announcement.size(), INADDR_LOOPBACK, 7410, {now_ns, now_ns}).fault,
        nullptr);
  chain.send({before});
  EXPECT_EQ(receiver.received(), 1);
}

}  // namespace swiftlet::dds::guarded_transport_test

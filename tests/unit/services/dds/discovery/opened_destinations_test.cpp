#include "swiftlet/services/dds/discovery/opened_destinations.hpp"

#include <arpa/inet.h>
#include <array>
#include <chrono>
#include <memory>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::comms::opened_destinations_test {

namespace transport = eprosima::fastdds::rtps;

// A socket of the loopback interface.
class Receiver {
 public:
  Receiver() {
    address_.sin_family = AF_INET;
    address_.sin_addr.s_addr = ::htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address_;
    auto* const address = reinterpret_cast<sockaddr*>(&address_);
    if (::bind(socket_, address, size) != 0 || ::getsockname(socket_, address, &size) != 0)
      throw std::runtime_error("no socket");
  }
  ~Receiver() { ::close(socket_); }
  Receiver(const Receiver&) = delete;
  Receiver& operator=(const Receiver&) = delete;

  rtps::Locator_t locator() const {
    rtps::Locator_t locator;
    rtps::IPLocator::createLocator(LOCATOR_KIND_UDPv4, "127.0.0.1", ::ntohs(address_.sin_port), locator);
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
  sockaddr_in address_{};
};

// Fast DDS 2.9 fails an assertion for a destination that it has not opened.
TEST(OpenedDestinations, GetWhatIsSentToAll) {
  const Receiver opened, other;
  auto udp = std::make_shared<transport::UDPv4TransportDescriptor>();
  udp->interfaceWhiteList = {"127.0.0.1"};
  const std::unique_ptr<transport::TransportInterface> chain(send_to_opened(udp)->create_transport());
  ASSERT_TRUE(chain->init());
  transport::SendResourceList channels;
  ASSERT_TRUE(chain->OpenOutputChannel(channels, opened.locator()));
  const std::vector<rtps::octet> datagram(100);
  const auto send_to_both = [&] {
    std::vector<rtps::Locator_t> both = {opened.locator(), other.locator()};
    for (auto& channel : channels) {
      rtps::Locators first(both.begin());
      rtps::Locators last(both.end());
      send(*channel, datagram, {&first, &last, std::chrono::steady_clock::now() + std::chrono::seconds(1)});
    }
  };

  send_to_both();
  EXPECT_EQ(opened.received(), 1);
  EXPECT_EQ(other.received(), 0);

  ASSERT_TRUE(chain->OpenOutputChannel(channels, other.locator()));
  EXPECT_EQ(channels.size(), 1U) << "sent twice otherwise";
  send_to_both();
  EXPECT_EQ(opened.received(), 1);
  EXPECT_EQ(other.received(), 1);
}

}  // namespace swiftlet::comms::opened_destinations_test

#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <chrono>
#include <utility>
#include <vector>

#include <fastdds/rtps/common/Locator.h>
#include <fastdds/rtps/common/PortParameters.h>
#include <fastdds/rtps/network/SenderResource.h>
#include <fastdds/rtps/transport/ChainingTransport.h>
#include <fastdds/rtps/transport/TransportReceiverInterface.h>

#include "swiftlet/services/dds/discovery/discovery_ports.hpp"

namespace swiftlet::comms {

bool is_discovery_port(int domain, std::uint32_t port) {
  const DiscoveryPorts ports = discovery_ports(domain);
  const std::uint32_t multicast =
      eprosima::fastrtps::rtps::PortParameters().getMulticastPort(static_cast<std::uint32_t>(domain));
  return port == multicast ||
         (port >= ports.first && port <= ports.last() && (port - ports.first) % ports.gap == 0);
}

namespace {

namespace transport = eprosima::fastdds::rtps;
namespace rtps = eprosima::fastrtps::rtps;
using Deadline = std::chrono::steady_clock::time_point;

// Sends through a channel of the transport below.
class RepeatingChannel final : public rtps::SenderResource {
 public:
  RepeatingChannel(int domain, std::unique_ptr<rtps::SenderResource> below)
      : SenderResource(below->kind()), domain_(domain), below_(std::move(below)) {
    send_lambda_ = [this](const rtps::octet* data, std::uint32_t size, rtps::LocatorsIterator* begin,
                          rtps::LocatorsIterator* end,
                          const Deadline& deadline) { return send_copies(data, size, begin, end, deadline); };
  }

  void add_locators_to_list(rtps::LocatorList_t& locators) const override {
    below_->add_locators_to_list(locators);
  }
  std::unique_ptr<rtps::SenderResource> take() { return std::move(below_); }

 private:
  bool send_copies(const rtps::octet* data, std::uint32_t size, rtps::LocatorsIterator* begin,
                   rtps::LocatorsIterator* end, const Deadline& deadline) {
    if (*begin == *end || !is_discovery_port(domain_, (**begin).port))
      return below_->send(data, size, begin, end, deadline);
    std::vector<rtps::Locator_t> receivers;
    for (; *begin != *end; ++*begin) receivers.push_back(**begin);
    bool sent = true;
    for (int copy = 0; copy < kDiscoveryCopies; ++copy) {
      rtps::Locators first(receivers.begin());
      rtps::Locators last(receivers.end());
      sent = below_->send(data, size, &first, &last, deadline) && sent;
    }
    return sent;
  }

  const int domain_;
  std::unique_ptr<rtps::SenderResource> below_;
};

class RepeatingTransport final : public transport::ChainingTransport {
 public:
  RepeatingTransport(const transport::ChainingTransportDescriptor& descriptor, int domain)
      : ChainingTransport(descriptor), domain_(domain) {}

  transport::TransportDescriptorInterface* get_configuration() override {
    return low_level_transport_->get_configuration();
  }
  void shutdown() override { low_level_transport_->shutdown(); }

  bool OpenInputChannel(const rtps::Locator_t& locator, transport::TransportReceiverInterface* next,
                        std::uint32_t largest_message) override {
    return low_level_transport_->OpenInputChannel(locator, next, largest_message);
  }

  // The transport below recognizes the channels that it opened before only if they are not wrapped.
  bool OpenOutputChannel(transport::SendResourceList& channels, const rtps::Locator_t& locator) override {
    transport::SendResourceList below;
    transport::SendResourceList others;
    for (auto& channel : channels) {
      auto* const repeating = dynamic_cast<RepeatingChannel*>(channel.get());
      if (repeating != nullptr) {
        below.push_back(repeating->take());
      } else {
        others.push_back(std::move(channel));
      }
    }
    const bool opened = low_level_transport_->OpenOutputChannel(below, locator);
    channels = std::move(others);
    for (auto& channel : below)
      channels.push_back(std::make_unique<RepeatingChannel>(domain_, std::move(channel)));
    return opened;
  }

  // The channels above pass these by.
  bool send(rtps::SenderResource* below, const rtps::octet* data, std::uint32_t size,
            rtps::LocatorsIterator* begin, rtps::LocatorsIterator* end, const Deadline& deadline) override {
    return below->send(data, size, begin, end, deadline);
  }
  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

 private:
  const int domain_;
};

struct RepeatingDescriptor final : transport::ChainingTransportDescriptor {
  RepeatingDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> below, int of)
      : ChainingTransportDescriptor(std::move(below)), domain(of) {}
  transport::TransportInterface* create_transport() const override {
    return new RepeatingTransport(*this, domain);
  }

  int domain;
};

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> repeat_discovery(
    std::shared_ptr<transport::TransportDescriptorInterface> below, int domain) {
  return std::make_shared<RepeatingDescriptor>(std::move(below), domain);
}

}  // namespace swiftlet::comms

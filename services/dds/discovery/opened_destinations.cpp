#include "swiftlet/services/dds/discovery/opened_destinations.hpp"

#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include "swiftlet/services/dds/datagram/output_channels.hpp"

namespace swiftlet::comms {
namespace {

namespace transport = eprosima::fastdds::rtps;

class Destinations {
 public:
  void add(const rtps::Locator_t& locator) {
    const std::lock_guard<std::mutex> lock(mutex_);
    opened_.insert(locator);
  }
  std::vector<rtps::Locator_t> opened_of(const Destination& all) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::vector<rtps::Locator_t> opened;
    for (; *all.begin != *all.end; ++*all.begin) {
      if (opened_.count(**all.begin) > 0) opened.push_back(**all.begin);
    }
    return opened;
  }

 private:
  mutable std::mutex mutex_;
  std::set<rtps::Locator_t> opened_;
};

class OpenedChannel final : public OutputChannel {
 public:
  OpenedChannel(std::shared_ptr<const Destinations> destinations, std::unique_ptr<rtps::SenderResource> below)
      : OutputChannel(std::move(below)), destinations_(std::move(destinations)) {}

 private:
  bool send_datagram(const OutgoingDatagram& datagram, const Destination& to) override {
    std::vector<rtps::Locator_t> opened = destinations_->opened_of(to);
    rtps::Locators first(opened.begin());
    rtps::Locators last(opened.end());
    return comms::send(below(), datagram, {&first, &last, to.deadline});
  }

  const std::shared_ptr<const Destinations> destinations_;
};

class OpenedTransport final : public ChainedTransport {
 public:
  using ChainedTransport::ChainedTransport;

  bool OpenInputChannel(const rtps::Locator_t& locator, transport::TransportReceiverInterface* next,
                        std::uint32_t largest_message) override {
    return low_level_transport_->OpenInputChannel(locator, next, largest_message);
  }

  bool OpenOutputChannel(transport::SendResourceList& channels, const rtps::Locator_t& locator) override {
    const bool opened = open_below(*low_level_transport_, channels, locator, [this](auto channel) {
      return std::make_unique<OpenedChannel>(destinations_, std::move(channel));
    });
    if (opened) destinations_->add(locator);
    return opened;
  }

  // The input channels pass this by.
  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

 private:
  const std::shared_ptr<Destinations> destinations_ = std::make_shared<Destinations>();
};

struct OpenedDescriptor final : transport::ChainingTransportDescriptor {
  using ChainingTransportDescriptor::ChainingTransportDescriptor;
  transport::TransportInterface* create_transport() const override { return new OpenedTransport(*this); }
};

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> send_to_opened(
    std::shared_ptr<transport::TransportDescriptorInterface> below) {
  return std::make_shared<OpenedDescriptor>(std::move(below));
}

}  // namespace swiftlet::comms

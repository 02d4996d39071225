#include "swiftlet/services/dds/datagram/guarded_transport.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/services/dds/datagram/output_channels.hpp"
#include "swiftlet/services/dds/discovery/interfaces.hpp"

namespace swiftlet::comms {
namespace {

namespace transport = eprosima::fastdds::rtps;

// Fast DDS takes the last fragment of a sample for as long as the first one said, however much there is: zeros follow it.
constexpr std::size_t kLongestFragment = 1 << 16;
// More than a domain has: forged announcements name others.
constexpr std::size_t kMostPlaces = 4 * kMostParticipants;

SenderAddress address_of(const rtps::Locator_t& locator) {
  SenderAddress address{};
  std::copy_n(locator.address, address.size(), address.begin());
  return address;
}

class GuardedTransport final : public ChainedTransport {
 public:
  GuardedTransport(const transport::ChainingTransportDescriptor& descriptor,
                   std::shared_ptr<DatagramGuard> guard, bool on_loopback, bool opens_places)
      : ChainedTransport(descriptor),
        guard_(std::move(guard)),
        on_loopback_(on_loopback),
        opens_places_(opens_places) {}

  // Fast DDS would drop the addresses of a process of this host that uses other interfaces, as ROS 2 does by default.
  bool leads_here(const rtps::Locator_t& announced, rtps::Locator_t& used) const override;

  // ChainingTransport takes a port for open after an attempt to open it has failed, and after it was closed.
  bool OpenInputChannel(const rtps::Locator_t& locator, transport::TransportReceiverInterface* next,
                        std::uint32_t largest_message) override;
  bool CloseInputChannel(const rtps::Locator_t& locator) override;

  bool OpenOutputChannel(transport::SendResourceList& channels, const rtps::Locator_t& locator) override;

  bool send_through(rtps::SenderResource& below, const OutgoingDatagram& datagram, const Destination& to) {
    if (!opens_places_ && !guard_->moved_hosts().any()) return send_to(below, datagram, to);
    // Allocates when a thread sends for the first time.
    thread_local std::vector<rtps::Locator_t> places;
    places.clear();
    for (; *to.begin != *to.end; ++*to.begin) places.push_back(opened(now_at(**to.begin)));
    rtps::Locators first(places.begin());
    rtps::Locators last(places.end());
    return send_to(below, datagram, {&first, &last, to.deadline});
  }
  bool send_to(rtps::SenderResource& below, const OutgoingDatagram& datagram, const Destination& to) {
    if (!guard_->seals()) {
      const OutgoingDatagram::Piece first = datagram.first_piece();
      guard_->note_sent(first.bytes, first.size);
      return comms::send(below, datagram, to);
    }
    // Allocates when a thread sends for the first time.
    thread_local std::vector<rtps::octet> sent(1 << 16);
    datagram.copy_to(sent);
    guard_->seal(sent, Now::read());
    return comms::send(below, sent, to);
  }

  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override;

 private:
  rtps::Locator_t now_at(rtps::Locator_t place) const;
  const rtps::Locator_t& opened(const rtps::Locator_t& place);

  // Receives from the transport below, for the next receiver.
  class Receiver final : public transport::TransportReceiverInterface {
   public:
    Receiver(GuardedTransport& owner, TransportReceiverInterface* next) : owner_(owner), next_(next) {}
    void OnDataReceived(const rtps::octet* data, std::uint32_t size, const rtps::Locator_t& local,
                        const rtps::Locator_t& remote) override {
      owner_.receive(next_, data, size, local, remote);
    }

   private:
    GuardedTransport& owner_;
    TransportReceiverInterface* const next_;
  };

  const std::shared_ptr<DatagramGuard> guard_;
  const bool on_loopback_;
  const bool opens_places_;
  // The participant opens channels and sends under one mutex of its own, which guards these.
  std::set<rtps::Locator_t> opened_;
  transport::SendResourceList found_;  // for interfaces that came up
  std::mutex receivers_mutex_;
  std::multimap<rtps::Locator_t, std::unique_ptr<Receiver>> receivers_;
};

// A channel of the transport below, through which a GuardedTransport sends.
class GuardedChannel final : public OutputChannel {
 public:
  GuardedChannel(GuardedTransport& owner, std::unique_ptr<rtps::SenderResource> below)
      : OutputChannel(std::move(below)), owner_(owner) {}

 private:
  bool send_datagram(const OutgoingDatagram& datagram, const Destination& to) override {
    return owner_.send_through(below(), datagram, to);
  }

  GuardedTransport& owner_;
};

bool GuardedTransport::leads_here(const rtps::Locator_t& announced, rtps::Locator_t& used) const {
  if (!on_loopback_ || announced.kind != LOCATOR_KIND_UDPv4) return false;
  if (!is_own_address(rtps::IPLocator::ip_to_string(announced))) return false;
  used = announced;
  rtps::IPLocator::setIPv4(used, kLoopback);
  return true;
}

rtps::Locator_t GuardedTransport::now_at(rtps::Locator_t place) const {
  if (place.kind != LOCATOR_KIND_UDPv4) return place;
  const Ipv4 address = guard_->moved_hosts().now_at(ipv4_of(address_of(place)));
  for (unsigned byte = 0; byte < 4; ++byte)
    place.address[12 + byte] = static_cast<rtps::octet>(address >> (24U - 8U * byte));
  return place;
}

// The transport of Fast DDS fails the assertion "it != collection_.end()" if it is to send to a place for which no channel was
// opened. A discovery server of 2.9 does that: it announces itself to a client that it has entered in its database, also if it
// has opened no channel for it yet (PDPServer::announceParticipantState, PDPServerListener).
const rtps::Locator_t& GuardedTransport::opened(const rtps::Locator_t& place) {
  if (opened_.size() >= kMostPlaces) opened_.clear();
  if (opened_.insert(place).second) low_level_transport_->OpenOutputChannel(found_, place);
  return place;
}

bool GuardedTransport::OpenOutputChannel(transport::SendResourceList& channels,
                                         const rtps::Locator_t& locator) {
  for (auto& channel : found_)
    channels.push_back(std::make_unique<GuardedChannel>(*this, std::move(channel)));
  found_.clear();
  return open_below(*low_level_transport_, channels, locator, [this](auto channel) {
    return std::make_unique<GuardedChannel>(*this, std::move(channel));
  });
}

bool GuardedTransport::OpenInputChannel(const rtps::Locator_t& locator,
                                        transport::TransportReceiverInterface* next,
                                        std::uint32_t largest_message) {
  const std::lock_guard<std::mutex> lock(receivers_mutex_);
  auto receiver = std::make_unique<Receiver>(*this, next);
  if (!low_level_transport_->OpenInputChannel(locator, receiver.get(), largest_message)) return false;
  receivers_.emplace(locator, std::move(receiver));
  return true;
}

bool GuardedTransport::CloseInputChannel(const rtps::Locator_t& locator) {
  const bool closed = low_level_transport_->CloseInputChannel(locator);  // waits for the thread that receives
  const std::lock_guard<std::mutex> lock(receivers_mutex_);
  if (closed) receivers_.erase(locator);
  return closed;
}

void GuardedTransport::receive(transport::TransportReceiverInterface* next, const rtps::octet* data,
                               std::uint32_t size, const rtps::Locator_t& local,
                               const rtps::Locator_t& remote) {
  if (!guard_->listens()) return;
  const SenderAddress sender = address_of(remote);
  const CheckedDatagram checked = guard_->admit(data, size, sender, local.port, Now::read());
  if (checked.fault != nullptr || checked.is_ignored) return;
  std::unique_lock<std::mutex> no_change;
  if (is_discovery_server(checked.source)) no_change = std::unique_lock(guard_->changes_mutex());
  try {
    const Ipv4 source = ipv4_of(sender);
    const bool lacks_address = checked.loopback_count > 0 && !is_loopback(source);
    if (checked.hidden_count > 0 || checked.fragment || lacks_address) {
      std::vector<rtps::octet> copy(checked.length + kLongestFragment);
      std::copy_n(data, checked.length, copy.begin());
      hide_parameters(checked, copy.data());
      if (lacks_address) name_source(checked, source, copy.data());
      next->OnDataReceived(copy.data(), static_cast<std::uint32_t>(checked.length), local, remote);
    } else {
      next->OnDataReceived(data, static_cast<std::uint32_t>(checked.length), local, remote);
    }
  } catch (const std::exception&) {
    guard_->refuse(sender, "the middleware could not parse it");
  }
}

struct GuardedUdp final : transport::ChainingTransportDescriptor {
  // Leaves room for the seal, if the middleware does not.
  std::uint32_t max_message_size() const override {
    return low_level_descriptor->max_message_size() -
           (guard->seals() ? static_cast<std::uint32_t>(kSealBytes) : 0U);
  }
  GuardedUdp(const transport::UDPv4TransportDescriptor& udp, std::shared_ptr<DatagramGuard> shared,
             bool opens)
      : ChainingTransportDescriptor(std::make_shared<transport::UDPv4TransportDescriptor>(udp)),
        on_loopback(udp.interfaceWhiteList == std::vector<std::string>{kLoopback}),
        opens_places(opens),
        guard(std::move(shared)) {}
  transport::TransportInterface* create_transport() const override {
    return new GuardedTransport(*this, guard, on_loopback, opens_places);
  }

  const bool on_loopback;
  const bool opens_places;
  std::shared_ptr<DatagramGuard> guard;
};

}  // namespace

TransportDescriptor guarded(const transport::UDPv4TransportDescriptor& udp,
                            std::shared_ptr<DatagramGuard> guard, bool opens_places) {
  return std::make_shared<GuardedUdp>(udp, std::move(guard), opens_places);
}

}  // namespace swiftlet::comms

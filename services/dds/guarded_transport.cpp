#include "swiftlet/services/dds/guarded_transport.hpp"

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/io/network/interfaces.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

namespace swiftlet::dds {
namespace {

namespace transport = eprosima::fastdds::rtps;

// Fast DDS takes the last fragment of a sample for as long as the first one said, however much there is: zeros follow it.
constexpr std::size_t kLongestFragment = 1 << 16;
// More than a domain has: forged announcements name others.
constexpr std::size_t kMostPlaces = 4 * rtps::kMostParticipants;

io::Ipv4 address_of(const fastrtps::Locator_t& locator) {
  return io::ByteReader(locator.address + 12, 4, false).u32();
}

class GuardedTransport final : public ChainedTransport {
 public:
  GuardedTransport(const transport::ChainingTransportDescriptor& descriptor,
                   std::shared_ptr<rtps::DatagramGuard> guard, bool on_loopback, std::optional<int> domain)
      : ChainedTransport(descriptor), guard_(std::move(guard)), on_loopback_(on_loopback), domain_(domain) {}

  // Fast DDS would drop the addresses of a process of this host that uses other interfaces, as ROS 2 does by default.
  bool leads_here(const fastrtps::Locator_t& announced, fastrtps::Locator_t& used) const override;

  // ChainingTransport takes a port for open after an attempt to open it has failed, and after it was closed.
  bool OpenInputChannel(const fastrtps::Locator_t& locator, transport::TransportReceiverInterface* next,
                        std::uint32_t largest_message) override;
  bool CloseInputChannel(const fastrtps::Locator_t& locator) override;

  bool OpenOutputChannel(transport::SendResourceList& channels, const fastrtps::Locator_t& locator) override;

  void receive(transport::TransportReceiverInterface* next, const fastrtps::octet* data, std::uint32_t size,
               const fastrtps::Locator_t& local, const fastrtps::Locator_t& remote) override;

 private:
  using Places = RepeatedDiscovery::Places;
  class Channel;
  class Receiver;

  fastrtps::Locator_t now_at(fastrtps::Locator_t place) const;
  const fastrtps::Locator_t& opened(const fastrtps::Locator_t& place);
  bool send_to(fastrtps::SenderResource& below, const OutgoingDatagram& datagram, const Destination& to);

  const std::shared_ptr<rtps::DatagramGuard> guard_;
  const bool on_loopback_;
  const std::optional<int> domain_;
  // The participant opens channels and sends under one mutex of its own, which guards these.
  std::set<fastrtps::Locator_t> opened_;
  transport::SendResourceList found_;  // for interfaces that came up
  std::mutex receivers_mutex_;
  std::multimap<fastrtps::Locator_t, std::unique_ptr<Receiver>> receivers_;
};

// Receives from the transport below, for the next receiver.
class GuardedTransport::Receiver final : public transport::TransportReceiverInterface {
 public:
  Receiver(GuardedTransport& owner, TransportReceiverInterface* next) : owner_(owner), next_(next) {}
  void OnDataReceived(const fastrtps::octet* data, std::uint32_t size, const fastrtps::Locator_t& local,
                      const fastrtps::Locator_t& remote) override {
    owner_.receive(next_, data, size, local, remote);
  }

 private:
  GuardedTransport& owner_;
  TransportReceiverInterface* const next_;
};

// Sends through a channel of the transport below.
class GuardedTransport::Channel final : public OutputChannel {
 public:
  Channel(GuardedTransport& owner, std::unique_ptr<fastrtps::SenderResource> below)
      : OutputChannel(std::move(below)), owner_(owner) {}

 private:
  bool send_datagram(const OutgoingDatagram& datagram, const Destination& to) override {
    const bool of_discovery =
        owner_.domain_ && *to.begin != *to.end && is_discovery_port(*owner_.domain_, (**to.begin).port);
    const bool redirects = !owner_.domain_ || owner_.guard_->has_moved_hosts();
    if (!of_discovery && !redirects) return owner_.send_to(below(), datagram, to);
    // Allocates when a thread sends for the first time.
    thread_local Places places;
    places.clear();
    for (; *to.begin != *to.end; ++*to.begin)
      places.push_back(redirects ? owner_.opened(owner_.now_at(**to.begin)) : **to.begin);
    if (!of_discovery) return send_to(places, datagram, to);
    std::vector<fastrtps::octet> bytes;
    datagram.copy_to(bytes);
    std::vector<Places> rounds = repeated_.rounds(bytes, places, *owner_.guard_);
    if (owner_.on_loopback_ && rounds.size() > 1) rounds.resize(1);  // it loses nothing
    bool sent = true;
    for (Places& round : rounds) sent = send_to(round, datagram, to) && sent;
    return sent;
  }
  bool send_to(Places& places, const OutgoingDatagram& datagram, const Destination& to) {
    fastrtps::Locators first(places.begin());
    fastrtps::Locators last(places.end());
    return owner_.send_to(below(), datagram, {&first, &last, to.deadline});
  }

  GuardedTransport& owner_;
  RepeatedDiscovery repeated_;
};

bool GuardedTransport::send_to(fastrtps::SenderResource& below, const OutgoingDatagram& datagram,
                               const Destination& to) {
  if (!guard_->seals()) {
    const OutgoingDatagram::Piece first = datagram.first_piece();
    guard_->note_sent(first.bytes, first.size);
    return dds::send(below, datagram, to);
  }
  // Allocates when a thread sends for the first time.
  thread_local std::vector<fastrtps::octet> sent(1 << 16);
  datagram.copy_to(sent);
  guard_->seal(sent, rtps::Now::read());
  return dds::send(below, sent, to);
}

bool GuardedTransport::leads_here(const fastrtps::Locator_t& announced, fastrtps::Locator_t& used) const {
  if (!on_loopback_ || announced.kind != LOCATOR_KIND_UDPv4) return false;
  if (!io::is_own_address(fastrtps::IPLocator::ip_to_string(announced))) return false;
  used = announced;
  fastrtps::IPLocator::setIPv4(used, io::kLoopback);
  return true;
}

fastrtps::Locator_t GuardedTransport::now_at(fastrtps::Locator_t place) const {
  if (place.kind != LOCATOR_KIND_UDPv4) return place;
  const io::Ipv4 address = guard_->now_at(address_of(place));
  for (unsigned byte = 0; byte < 4; ++byte)
    place.address[12 + byte] = static_cast<fastrtps::octet>(address >> (24U - 8U * byte));
  return place;
}

// The transport of Fast DDS fails the assertion "it != collection_.end()" if it is to send to a place for which no channel was
// opened. A discovery server of 2.9 does that: it announces itself to a client that it has entered in its database, also if it
// has opened no channel for it yet (PDPServer::announceParticipantState, PDPServerListener).
const fastrtps::Locator_t& GuardedTransport::opened(const fastrtps::Locator_t& place) {
  if (opened_.size() >= kMostPlaces) opened_.clear();
  if (opened_.insert(place).second) low_level_transport_->OpenOutputChannel(found_, place);
  return place;
}

// The transport below recognizes the channels that it opened before only if they are not wrapped, and would open a second one and
// send everything twice: they are unwrapped meanwhile. All are of this transport, since a participant has no other.
bool GuardedTransport::OpenOutputChannel(transport::SendResourceList& channels,
                                         const fastrtps::Locator_t& locator) {
  transport::SendResourceList below;
  for (auto& channel : channels) below.push_back(static_cast<OutputChannel&>(*channel).take());
  for (auto& channel : found_) below.push_back(std::move(channel));
  found_.clear();
  const bool is_open = low_level_transport_->OpenOutputChannel(below, locator);
  channels.clear();
  for (auto& channel : below) channels.push_back(std::make_unique<Channel>(*this, std::move(channel)));
  return is_open;
}

bool GuardedTransport::OpenInputChannel(const fastrtps::Locator_t& locator,
                                        transport::TransportReceiverInterface* next,
                                        std::uint32_t largest_message) {
  const std::lock_guard<std::mutex> lock(receivers_mutex_);
  auto receiver = std::make_unique<Receiver>(*this, next);
  if (!low_level_transport_->OpenInputChannel(locator, receiver.get(), largest_message)) return false;
  if (domain_ && guard_->discovery_port() == 0 && discovery_ports(*domain_).index_of(locator.port))
    guard_->set_discovery_port(locator.port);
  receivers_.emplace(locator, std::move(receiver));
  return true;
}

bool GuardedTransport::CloseInputChannel(const fastrtps::Locator_t& locator) {
  const bool closed = low_level_transport_->CloseInputChannel(locator);  // waits for the thread that receives
  const std::lock_guard<std::mutex> lock(receivers_mutex_);
  if (closed) receivers_.erase(locator);
  return closed;
}

void GuardedTransport::receive(transport::TransportReceiverInterface* next, const fastrtps::octet* data,
                               std::uint32_t size, const fastrtps::Locator_t& local,
                               const fastrtps::Locator_t& remote) {
  if (!guard_->listens()) return;
  const io::Ipv4 sender = address_of(remote);
  const rtps::CheckedDatagram checked = guard_->admit(data, size, sender, local.port, rtps::Now::read());
  if (checked.fault != nullptr || checked.is_ignored) return;
  std::unique_lock<std::mutex> turn;
  if (guard_->takes_turns(checked)) turn = std::unique_lock(guard_->turn_mutex());
  try {
    const bool lacks_address = !checked.places.loopback.empty() && !io::is_loopback(sender);
    if (!checked.places.hidden.empty() || checked.fragment || lacks_address) {
      std::vector<fastrtps::octet> copy(checked.length + kLongestFragment);
      std::copy_n(data, checked.length, copy.begin());
      rtps::hide_parameters(checked, copy.data());
      if (lacks_address) rtps::name_source(checked, sender, copy.data());
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
           (guard->seals() ? static_cast<std::uint32_t>(rtps::kSealBytes) : 0U);
  }
  GuardedUdp(const transport::UDPv4TransportDescriptor& udp, std::shared_ptr<rtps::DatagramGuard> shared,
             std::optional<int> of)
      : ChainingTransportDescriptor(std::make_shared<transport::UDPv4TransportDescriptor>(udp)),
        on_loopback(udp.interfaceWhiteList == std::vector<std::string>{io::kLoopback}),
        domain(of),
        guard(std::move(shared)) {}
  transport::TransportInterface* create_transport() const override {
    return new GuardedTransport(*this, guard, on_loopback, domain);
  }

  const bool on_loopback;
  const std::optional<int> domain;
  std::shared_ptr<rtps::DatagramGuard> guard;
};

}  // namespace

TransportDescriptor guarded(const transport::UDPv4TransportDescriptor& udp,
                            std::shared_ptr<rtps::DatagramGuard> guard, std::optional<int> domain) {
  return std::make_shared<GuardedUdp>(udp, std::move(guard), domain);
}

}  // namespace swiftlet::dds

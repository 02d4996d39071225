#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <algorithm>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/dds/datagram/output_channels.hpp"
#include "swiftlet/services/dds/datagram/rtps_ids.hpp"
#include "swiftlet/services/dds/datagram/submessage.hpp"
#include "swiftlet/services/dds/discovery/announcement_budget.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"

namespace swiftlet::comms {

using runtime::ByteReader;

bool is_discovery_port(int domain, std::uint32_t port) {
  const DiscoveryPorts ports = discovery_ports(domain);
  const std::uint32_t multicast = rtps::PortParameters().getMulticastPort(static_cast<std::uint32_t>(domain));
  return port == multicast ||
         (port >= ports.first && port <= ports.last() && (port - ports.first) % ports.gap == 0);
}

namespace {

// More than a domain has: forged announcements name others.
constexpr std::size_t kMostDestinations = 4 * kMostParticipants;

// FNV-1a, 64 bits.
constexpr std::uint64_t kFnvOffset = 0xcbf29ce484222325U;
constexpr std::uint64_t kFnvPrime = 0x100000001b3U;

std::uint64_t fnv(std::uint64_t digest, const std::uint8_t* bytes, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i) digest = (digest ^ bytes[i]) * kFnvPrime;
  return digest;
}

bool is_of_participant(ByteReader data) {
  data.skip(kBytesBeforeIds);
  const EntityId reader = entity_id(data);
  const EntityId writer = entity_id(data);
  const auto topic = topic_of(reader, writer);
  return topic == BuiltinTopic::kParticipant || topic == BuiltinTopic::kLiveliness;
}

}  // namespace

std::optional<std::uint64_t> announcement_digest(const std::uint8_t* message, std::size_t size) {
  std::uint64_t digest = kFnvOffset;
  bool announces_only = true;
  const bool whole = for_each_submessage(message, size, [&](std::uint8_t kind, const ByteReader& body) {
    if (kind == kInfoDestination || kind == kInfoTimestamp || kind == kStatistics) return;
    announces_only = announces_only && kind == kData && is_of_participant(body);
    digest = fnv(digest, body.data(), body.rest());
  });
  return whole && announces_only ? std::optional(digest) : std::nullopt;
}

namespace {

namespace transport = eprosima::fastdds::rtps;

struct Repetition {
  int domain;
  std::shared_ptr<DatagramGuard> guard;
  std::shared_ptr<const std::atomic<bool>> listening;
  bool loses_nothing;
};

// Sends through a channel of the transport below.
class RepeatingChannel final : public OutputChannel {
 public:
  RepeatingChannel(const Repetition& repetition, std::unique_ptr<rtps::SenderResource> below)
      : OutputChannel(std::move(below)), repetition_(repetition) {}

 private:
  struct Receiver {
    rtps::Locator_t locator;
    int copies;
  };

  bool send_datagram(const OutgoingDatagram& datagram, const Destination& to) override {
    if (*to.begin == *to.end || !is_discovery_port(repetition_.domain, (**to.begin).port))
      return comms::send(below(), datagram, to);
    std::vector<Receiver> receivers;
    for (; *to.begin != *to.end; ++*to.begin) receivers.push_back({**to.begin, 0});
    set_copies(datagram, receivers);
    const int most = repetition_.loses_nothing ? 1 : std::max(kEndpointCopies, kAnnouncementCopies);
    bool sent = true;
    std::vector<rtps::Locator_t> due;
    for (int copy = 0; copy < most; ++copy) {
      due.clear();
      for (const Receiver& receiver : receivers) {
        if (receiver.copies > copy) due.push_back(receiver.locator);
      }
      if (due.empty()) break;
      rtps::Locators first(due.begin());
      rtps::Locators last(due.end());
      sent = comms::send(below(), datagram, {&first, &last, to.deadline}) && sent;
    }
    return sent;
  }

  void set_copies(const OutgoingDatagram& datagram, std::vector<Receiver>& receivers) {
    std::vector<rtps::octet> bytes;
    datagram.copy_to(bytes);
    const auto digest = announcement_digest(bytes.data(), bytes.size());
    const Now now = Now::read();
    const std::size_t processes = repetition_.guard->participants_heard(now);
    if (!digest) {
      for (Receiver& receiver : receivers) receiver.copies = endpoint_copies(processes);
      return;
    }
    if (!*repetition_.listening) return;
    std::map<std::uint32_t, std::int64_t>
        joined_ns;  // by port: Fast DDS sends to own hosts by other addresses
    for (const Joined& joined : repetition_.guard->participants_joined(now))
      joined_ns[joined.discovery_port] = std::max(joined_ns[joined.discovery_port], joined.since_ns);
    const std::lock_guard<std::mutex> lock(budgets_mutex_);
    if (budgets_.size() > kMostDestinations) budgets_.clear();
    for (Receiver& receiver : receivers) {
      const auto joined = joined_ns.find(receiver.locator.port);
      receiver.copies = budgets_[receiver.locator].copies(
          *digest, processes, joined == joined_ns.end() ? 0 : joined->second, now.steady_ns);
    }
  }

  const Repetition repetition_;
  std::mutex budgets_mutex_;
  std::map<rtps::Locator_t, AnnouncementBudget> budgets_;
};

class RepeatingTransport final : public ChainedTransport {
 public:
  RepeatingTransport(const transport::ChainingTransportDescriptor& descriptor, const Repetition& repetition)
      : ChainedTransport(descriptor), repetition_(repetition) {}

  bool OpenInputChannel(const rtps::Locator_t& locator, transport::TransportReceiverInterface* next,
                        std::uint32_t largest_message) override {
    return low_level_transport_->OpenInputChannel(locator, next, largest_message);
  }

  bool OpenOutputChannel(transport::SendResourceList& channels, const rtps::Locator_t& locator) override {
    return open_below(*low_level_transport_, channels, locator, [this](auto channel) {
      return std::make_unique<RepeatingChannel>(repetition_, std::move(channel));
    });
  }

  // The input channels pass this by.
  void receive(transport::TransportReceiverInterface* next, const rtps::octet* data, std::uint32_t size,
               const rtps::Locator_t& local, const rtps::Locator_t& remote) override {
    next->OnDataReceived(data, size, local, remote);
  }

 private:
  const Repetition repetition_;
};

struct RepeatingDescriptor final : transport::ChainingTransportDescriptor {
  RepeatingDescriptor(std::shared_ptr<transport::TransportDescriptorInterface> below, Repetition of)
      : ChainingTransportDescriptor(std::move(below)), repetition(std::move(of)) {}
  transport::TransportInterface* create_transport() const override {
    return new RepeatingTransport(*this, repetition);
  }

  Repetition repetition;
};

}  // namespace

std::shared_ptr<transport::TransportDescriptorInterface> repeat_discovery(
    std::shared_ptr<transport::TransportDescriptorInterface> below, int domain,
    std::shared_ptr<DatagramGuard> guard, std::shared_ptr<const std::atomic<bool>> listening,
    bool loses_nothing) {
  return std::make_shared<RepeatingDescriptor>(
      std::move(below), Repetition{domain, std::move(guard), std::move(listening), loses_nothing});
}

}  // namespace swiftlet::comms

#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <algorithm>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/dds/datagram/rtps_ids.hpp"
#include "swiftlet/services/dds/datagram/submessage.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"

namespace swiftlet::comms {

using runtime::ByteReader;

bool is_discovery_port(int domain, std::uint32_t port) {
  const std::uint32_t multicast = rtps::PortParameters().getMulticastPort(static_cast<std::uint32_t>(domain));
  return port == multicast || discovery_ports(domain).index_of(port);
}

namespace {

// More than a domain has: forged announcements name others.
constexpr std::size_t kMostDestinations = 4 * kMostParticipants;

bool is_of_participant(ByteReader data) {
  data.skip(kBytesBeforeIds);
  const EntityId reader = entity_id(data);
  const EntityId writer = entity_id(data);
  const auto topic = topic_of(reader, writer);
  return topic == BuiltinTopic::kParticipant || topic == BuiltinTopic::kLiveliness;
}

}  // namespace

std::optional<std::uint64_t> announcement_digest(const std::uint8_t* message, std::size_t size) {
  std::uint64_t digest = fnv(nullptr, 0);
  bool announces_only = true;
  const bool whole = for_each_submessage(message, size, [&](std::uint8_t kind, const ByteReader& body) {
    if (kind == kInfoDestination || kind == kInfoTimestamp || kind == kStatistics) return;
    announces_only = announces_only && kind == kData && is_of_participant(body);
    digest = fnv(body.data(), body.rest(), digest);
  });
  return whole && announces_only ? std::optional(digest) : std::nullopt;
}

std::vector<RepeatedDiscovery::Places> RepeatedDiscovery::rounds(const std::vector<std::uint8_t>& datagram,
                                                                 const Places& places, DatagramGuard& guard) {
  const auto digest = announcement_digest(datagram.data(), datagram.size());
  const Now now = Now::read();
  const std::size_t processes = guard.participants_heard(now);
  if (!digest) return std::vector<Places>(static_cast<std::size_t>(endpoint_copies(processes)), places);
  if (!guard.listens()) return {};
  // By port: Fast DDS sends to own hosts by other addresses.
  std::map<std::uint32_t, std::int64_t> joined_ns;
  for (const Joined& joined : guard.participants_joined(now))
    joined_ns[joined.discovery_port] = std::max(joined_ns[joined.discovery_port], joined.since_ns);
  if (budgets_.size() > kMostDestinations) budgets_.clear();
  std::vector<Places> rounds;
  for (const rtps::Locator_t& place : places) {
    const auto joined = joined_ns.find(place.port);
    const int copies = budgets_[place].copies(*digest, processes,
                                              joined == joined_ns.end() ? 0 : joined->second, now.steady_ns);
    if (rounds.size() < static_cast<std::size_t>(copies)) rounds.resize(static_cast<std::size_t>(copies));
    for (int copy = 0; copy < copies; ++copy) rounds[static_cast<std::size_t>(copy)].push_back(place);
  }
  return rounds;
}

}  // namespace swiftlet::comms

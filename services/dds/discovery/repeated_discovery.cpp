#include "swiftlet/services/dds/discovery/repeated_discovery.hpp"

#include <algorithm>

#include "swiftlet/io/byte_reader.hpp"
#include "swiftlet/services/dds/discovery/discovery_ports.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"
#include "swiftlet/services/rtps/submessage.hpp"

namespace swiftlet::dds {

using io::ByteReader;

bool is_discovery_port(int domain, std::uint32_t port) {
  const std::uint32_t multicast =
      fastrtps::PortParameters().getMulticastPort(static_cast<std::uint32_t>(domain));
  return port == multicast || discovery_ports(domain).index_of(port);
}

namespace {

// More than a domain has: forged announcements name others.
constexpr std::size_t kMostDestinations = 4 * rtps::kMostParticipants;

bool is_of_participant(ByteReader data) {
  data.skip(rtps::kBytesBeforeIds);
  const rtps::EntityId reader = rtps::entity_id(data);
  const rtps::EntityId writer = rtps::entity_id(data);
  const auto topic = rtps::topic_of(reader, writer);
  return topic == rtps::BuiltinTopic::kParticipant || topic == rtps::BuiltinTopic::kLiveliness;
}

bool is_handshake(const std::vector<std::uint8_t>& datagram) {
  bool found = false;
  rtps::for_each_submessage(datagram.data(), datagram.size(), [&](std::uint8_t kind, ByteReader body) {
    if (kind != rtps::kData) return;
    body.skip(rtps::kBytesBeforeIds);
    const rtps::EntityId reader = rtps::entity_id(body);
    found = found || rtps::topic_of(reader, rtps::entity_id(body)) == rtps::BuiltinTopic::kHandshake;
  });
  return found;
}

}  // namespace

std::optional<std::uint64_t> announcement_digest(const std::uint8_t* message, std::size_t size) {
  std::uint64_t digest = rtps::fnv(nullptr, 0);
  bool announces_only = true;
  const bool whole = rtps::for_each_submessage(message, size, [&](std::uint8_t kind, const ByteReader& body) {
    if (kind == rtps::kInfoDestination || kind == rtps::kInfoTimestamp || kind == rtps::kStatistics) return;
    announces_only = announces_only && kind == rtps::kData && is_of_participant(body);
    digest = rtps::fnv(body.data(), body.rest(), digest);
  });
  return whole && announces_only ? std::optional(digest) : std::nullopt;
}

std::vector<RepeatedDiscovery::Places> RepeatedDiscovery::rounds(const std::vector<std::uint8_t>& datagram,
                                                                 const Places& places,
                                                                 rtps::DatagramGuard& guard) {
  const auto digest = announcement_digest(datagram.data(), datagram.size());
  const rtps::Now now = rtps::Now::read();
  const std::size_t processes = guard.participants_heard(now);
  if (is_handshake(datagram)) return std::vector<Places>(kHandshakeCopies, places);
  if (!digest) return std::vector<Places>(static_cast<std::size_t>(endpoint_copies(processes)), places);
  if (!guard.listens()) return {};
  // By port: Fast DDS sends to own hosts by other addresses.
  std::map<std::uint32_t, std::int64_t> joined_ns;
  for (const rtps::Joined& joined : guard.participants_joined(now))
    joined_ns[joined.discovery_port] = std::max(joined_ns[joined.discovery_port], joined.since_ns);
  if (budgets_.size() > kMostDestinations) budgets_.clear();
  std::vector<Places> rounds;
  for (const fastrtps::Locator_t& place : places) {
    const auto joined = joined_ns.find(place.port);
    const int copies = budgets_[place].copies(*digest, processes,
                                              joined == joined_ns.end() ? 0 : joined->second, now.steady_ns);
    if (rounds.size() < static_cast<std::size_t>(copies)) rounds.resize(static_cast<std::size_t>(copies));
    for (int copy = 0; copy < copies; ++copy) rounds[static_cast<std::size_t>(copy)].push_back(place);
  }
  return rounds;
}

}  // namespace swiftlet::dds

// Bounds how fast unknown participants may join, each of which costs memory until its lease ends; and holds known ones to
// what they announced: a changed copy could end the lease of a participant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/services/dds/datagram/rtps_ids.hpp"
#include "swiftlet/services/dds/datagram/token_bucket.hpp"

namespace swiftlet::comms {

// Participants that a process knows at the same time, itself included.
constexpr std::size_t kMostParticipants = 512;
// Readers, and writers, of all those participants: as many as 150 vehicles have.
constexpr std::size_t kMostEndpoints = 8192;

// Of a host: an IPv4 or IPv6 address as in a locator.
using SenderAddress = std::array<std::uint8_t, 16>;

// What the last announcement of a participant said.
struct ParticipantNews {
  std::uint64_t digest = 0;  // of the announcement; 0 for other datagrams about the participant
  std::uint32_t discovery_port = 0;
  bool concerns_us = true;  // else it is ignored, unless it has joined before
};

struct Admission {
  const char* fault = nullptr;  // the broken rule, a string literal
  bool has_joined = false;      // it has not been ignored once
};

// A participant that has joined.
struct Joined {
  std::uint32_t discovery_port = 0;
  std::int64_t since_ns = 0;  // of a monotonic clock
};

// Each host may announce 256 participants at once, and 4 more each second; all hosts together 512, and 16. Allocates
// only when constructed. Not thread-safe.
class ParticipantAdmission {
 public:
  ParticipantAdmission();

  // Without fault if the participant may join, or announces what it did before. A different announcement is accepted when it
  // arrives three times in a row. now_ns: of a monotonic clock.
  Admission admit(const GuidPrefix& participant, const ParticipantNews& news, const SenderAddress& host,
                  std::int64_t now_ns);

  // Participants that have announced themselves within the last seconds.
  std::size_t heard_lately(std::int64_t now_ns) const;
  // Those of them that have joined.
  std::vector<Joined> joined(std::int64_t now_ns) const;

 private:
  struct Known {
    GuidPrefix participant{};
    std::int64_t heard_ns = 0;
    std::uint64_t digest = 0;
    std::uint64_t other_digest = 0;  // of the last announcement, if it differed; else 0
    int repeated = 0;                // how often that was repeated
    std::uint32_t discovery_port = 0;
    std::int64_t joined_ns = 0;  // 0: it is ignored

    bool is_heard(std::int64_t now_ns) const;
    bool agrees(std::uint64_t announced);
  };
  struct Host {
    SenderAddress address{};
    std::int64_t heard_ns = 0;
    TokenBucket tokens;
  };

  Host& host(const SenderAddress& address, std::int64_t now_ns);

  std::vector<Known> known_;  // the longest silent one is replaced
  std::vector<Host> hosts_;
  TokenBucket all_;
};

}  // namespace swiftlet::comms

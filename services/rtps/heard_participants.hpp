// The participants that announced themselves to this one, and which of them it ignores.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/services/rtps/parameter_list.hpp"
#include "swiftlet/services/rtps/rtps_ids.hpp"

namespace swiftlet::rtps {

// Participants that a process knows at the same time, itself included.
constexpr std::size_t kMostParticipants = 512;
// Readers, and writers, of all those participants: as many as 150 vehicles have.
constexpr std::size_t kMostEndpoints = 8192;

// A participant that has joined.
struct Joined {
  std::uint32_t discovery_port = 0;
  std::int64_t since_ns = 0;  // of a monotonic clock
};

// Remembers kMostParticipants; of more, the longest silent one is forgotten. Allocates only when constructed. Not
// thread-safe. now_ns: of a monotonic clock.
class HeardParticipants {
 public:
  HeardParticipants() : known_(kMostParticipants) {}

  // Notes what a participant says about itself. concerns_us: else it is ignored, unless it has joined before. Returns whether it
  // has joined: it was not ignored once.
  bool announced(const GuidPrefix& participant, const Announced& said, bool concerns_us, std::int64_t now_ns);

  // Participants that have announced themselves within the last seconds.
  std::size_t heard_lately(std::int64_t now_ns) const;
  // The participants heard lately that have joined.
  std::vector<Joined> joined(std::int64_t now_ns) const;
  // The name that a participant said last, shortened if it is long; empty if it is not known. Nothing proves the name.
  std::string name_of(const GuidPrefix& participant) const;

 private:
  struct Known {
    GuidPrefix participant{};
    std::int64_t heard_ns = 0;
    std::uint32_t discovery_port = 0;
    std::int64_t joined_ns = 0;  // 0: it is ignored
    std::array<char, 32> name{};

    bool is_heard(std::int64_t now_ns) const;
  };

  std::vector<Known> known_;
};

}  // namespace swiftlet::rtps

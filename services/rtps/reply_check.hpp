// Refuses replies that do not fit to what this participant has sent. Fast DDS reads beyond a sample when it is asked for
// fragments that the sample does not have, and keeps each number of a gap that its reader cannot use yet in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "swiftlet/services/rtps/check.hpp"

namespace swiftlet::rtps {

// Gaps may reach so far beyond the samples that the reader of a writer has acknowledged.
constexpr std::uint32_t kGapsAhead = 4096;

// Not thread-safe.
class ReplyCheck {
 public:
  // gaps_ahead: of writers of the middleware itself; kGapsAhead unless discovery servers skip announcements.
  explicit ReplyCheck(std::uint32_t gaps_ahead);

  // own: whose requests are checked, and those that name no participant. The middleware ignores requests to others, such as
  // one that had this port before. All zeros, as at the start: this participant has no writers yet.
  void set_participant(const GuidPrefix& own) { own_ = own; }

  // Whether a message that is sent holds acknowledgements or fragments.
  static bool concerns_replies(const std::uint8_t* message, std::size_t size);
  // Notes them. Ignores what it cannot read.
  void note_sent(const std::uint8_t* message, std::size_t size);

  // Returns the broken rule, or nullptr.
  const char* fault_of(const CheckedDatagram& received) const;

 private:
  static constexpr std::size_t kWriters = 4096;
  static constexpr std::size_t kSamplesOfWriter = 64;  // the depth of request topics

  struct Acknowledged {
    GuidPrefix participant{};
    EntityId writer{};
    std::uint32_t base = 0;  // all samples before it are
  };

  static std::size_t place_of(const GuidPrefix& participant, const EntityId& writer);
  std::uint32_t acknowledged(const GuidPrefix& participant, const EntityId& writer) const;

  const std::uint32_t gaps_ahead_;
  GuidPrefix own_{};
  // By hash: of two writers in one place the one is known that was acknowledged last.
  std::vector<Acknowledged> acknowledged_;
  std::map<EntityId, std::map<std::uint32_t, std::uint32_t>>
      fragments_;  // of the newest samples of each writer
};

}  // namespace swiftlet::rtps

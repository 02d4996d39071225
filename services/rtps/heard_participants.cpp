#include "swiftlet/services/rtps/heard_participants.hpp"

#include <algorithm>

namespace swiftlet::rtps {
namespace {

constexpr std::int64_t kJoinedLately_ns = 4'000'000'000;  // twice the lease of a process
// Those that are ignored announce themselves seldom in a large domain (announcement_budget.hpp).
constexpr std::int64_t kIgnoredLately_ns = 20'000'000'000;

}  // namespace

bool HeardParticipants::Known::is_heard(std::int64_t now_ns) const {
  return heard_ns > 0 && now_ns - heard_ns < (joined_ns != 0 ? kJoinedLately_ns : kIgnoredLately_ns);
}

bool HeardParticipants::announced(const GuidPrefix& participant, const Announced& said, bool concerns_us,
                                  std::int64_t now_ns) {
  auto known = std::find_if(known_.begin(), known_.end(),
                            [&](const Known& other) { return other.participant == participant; });
  if (known == known_.end()) {
    // Entries that were never used have been silent longest.
    known = std::min_element(known_.begin(), known_.end(),
                             [](const Known& a, const Known& b) { return a.heard_ns < b.heard_ns; });
    *known = {participant};
  }
  known->heard_ns = now_ns;
  known->discovery_port = said.discovery_port;
  known->name = {};
  if (said.name != nullptr)
    std::copy_n(said.name, std::min(said.name_size, known->name.size()), known->name.begin());
  if (concerns_us && known->joined_ns == 0) known->joined_ns = now_ns;
  return known->joined_ns != 0;
}

std::size_t HeardParticipants::heard_lately(std::int64_t now_ns) const {
  return static_cast<std::size_t>(std::count_if(
      known_.begin(), known_.end(), [now_ns](const Known& known) { return known.is_heard(now_ns); }));
}

std::vector<Joined> HeardParticipants::joined(std::int64_t now_ns) const {
  std::vector<Joined> joined;
  for (const Known& known : known_) {
    if (known.joined_ns != 0 && known.is_heard(now_ns))
      joined.push_back({known.discovery_port, known.joined_ns});
  }
  return joined;
}

std::string HeardParticipants::name_of(const GuidPrefix& participant) const {
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& other) { return other.participant == participant; });
  if (known == known_.end()) return {};
  return {known->name.begin(), std::find(known->name.begin(), known->name.end(), '\0')};
}

}  // namespace swiftlet::rtps

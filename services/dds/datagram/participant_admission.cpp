#include "swiftlet/services/dds/datagram/participant_admission.hpp"

#include <algorithm>

namespace swiftlet::comms {
namespace {

constexpr double kBurstOfHost = 256.0;
constexpr double kRateOfHost = 4.0;  // 1/s
constexpr double kBurstOfAll = 512.0;
constexpr double kRateOfAll = 16.0;  // 1/s
constexpr std::size_t kHosts = 64;
constexpr std::int64_t kAdmittedLately_ns = 4'000'000'000;  // twice the lease of a process
// Those that are ignored announce themselves seldom in a large domain (announcement_budget.hpp).
constexpr std::int64_t kIgnoredLately_ns = 20'000'000'000;

// Entries that were never used have been silent longest.
template <class T>
T& longest_silent(std::vector<T>& all) {
  return *std::min_element(all.begin(), all.end(),
                           [](const T& a, const T& b) { return a.heard_ns < b.heard_ns; });
}

}  // namespace

ParticipantAdmission::ParticipantAdmission()
    : known_(kMostParticipants), hosts_(kHosts), all_(kBurstOfAll, kRateOfAll) {}

bool ParticipantAdmission::Known::agrees(std::uint64_t announced) {
  constexpr int kRepetitions = 2;
  if (announced == 0) return true;
  if (announced == digest) {
    other_digest = 0;
    return true;
  }
  repeated = announced == other_digest ? repeated + 1 : 0;
  other_digest = announced;
  if (digest != 0 && repeated < kRepetitions) return false;
  digest = announced;
  return true;
}

bool ParticipantAdmission::Known::is_heard(std::int64_t now_ns) const {
  return heard_ns > 0 && now_ns - heard_ns < (joined_ns != 0 ? kAdmittedLately_ns : kIgnoredLately_ns);
}

Admission ParticipantAdmission::admit(const GuidPrefix& participant, const ParticipantNews& news,
                                      const SenderAddress& address, std::int64_t now_ns) {
  const auto found = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& other) { return other.participant == participant; });
  if (found == known_.end() && (!host(address, now_ns).tokens.take(now_ns) || !all_.take(now_ns)))
    return {"more new participants than a host may announce"};
  Known& known = found == known_.end() ? longest_silent(known_) : *found;
  if (found == known_.end()) known = {participant, now_ns, news.digest};
  known.heard_ns = now_ns;
  if (!known.agrees(news.digest))
    return {"announcement that differs from the participant's earlier ones (8.5.3)"};
  if (news.digest != 0) known.discovery_port = news.discovery_port;
  if (news.concerns_us && known.joined_ns == 0) known.joined_ns = now_ns;
  return {nullptr, known.joined_ns != 0};
}

std::size_t ParticipantAdmission::heard_lately(std::int64_t now_ns) const {
  return static_cast<std::size_t>(std::count_if(
      known_.begin(), known_.end(), [now_ns](const Known& known) { return known.is_heard(now_ns); }));
}

std::vector<Joined> ParticipantAdmission::joined(std::int64_t now_ns) const {
  std::vector<Joined> joined;
  for (const Known& known : known_) {
    if (known.joined_ns != 0 && known.is_heard(now_ns))
      joined.push_back({known.discovery_port, known.joined_ns});
  }
  return joined;
}

ParticipantAdmission::Host& ParticipantAdmission::host(const SenderAddress& address, std::int64_t now_ns) {
  const auto known = std::find_if(hosts_.begin(), hosts_.end(), [&](const Host& other) {
    return other.heard_ns > 0 && other.address == address;
  });
  Host& host = known != hosts_.end() ? *known : longest_silent(hosts_);
  if (known == hosts_.end()) host = {address, 0, TokenBucket(kBurstOfHost, kRateOfHost)};
  host.heard_ns = now_ns;
  return host;
}

}  // namespace swiftlet::comms

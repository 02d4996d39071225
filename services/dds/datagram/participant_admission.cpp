#include "swiftlet/services/dds/datagram/participant_admission.hpp"

#include <algorithm>

namespace swiftlet::comms {
namespace {

constexpr double kBurstOfHost = 256.0;
constexpr double kRateOfHost = 4.0;  // 1/s
constexpr double kBurstOfAll = 512.0;
constexpr double kRateOfAll = 16.0;  // 1/s
constexpr std::size_t kHosts = 64;
constexpr std::int64_t kLately_ns = 4'000'000'000;  // twice the lease of a process

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

const char* ParticipantAdmission::admit(const GuidPrefix& participant, std::uint64_t digest,
                                        const SenderAddress& address, std::int64_t now_ns) {
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& other) { return other.participant == participant; });
  if (known != known_.end()) {
    known->heard_ns = now_ns;
    return known->agrees(digest) ? nullptr
                                 : "announcement that differs from the participant's earlier ones (8.5.3)";
  }
  if (!host(address, now_ns).tokens.take(now_ns) || !all_.take(now_ns))
    return "more new participants than a host may announce";
  longest_silent(known_) = {participant, now_ns, digest, 0, 0};
  return nullptr;
}

std::size_t ParticipantAdmission::heard_lately(std::int64_t now_ns) const {
  return static_cast<std::size_t>(std::count_if(known_.begin(), known_.end(), [now_ns](const Known& known) {
    return known.heard_ns > 0 && now_ns - known.heard_ns < kLately_ns;
  }));
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

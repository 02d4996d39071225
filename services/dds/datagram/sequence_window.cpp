#include "swiftlet/services/dds/datagram/sequence_window.hpp"

#include <algorithm>
#include <cstring>

namespace swiftlet::comms {
namespace {

constexpr double kShortestInterval_ns = 50e3;  // also of a writer that was heard once
constexpr double kAveraged_ns = 0.25e9;        // in which the usual rate is measured
constexpr double kCatchUp_ns = 1e9;            // after which a writer is no longer taken to be behind
constexpr double kRateMargin = 4.0;

std::size_t hash(const GuidPrefix& participant, const EntityId& entity) {
  std::uint64_t words[2];
  std::memcpy(words, participant.data(), 8);
  std::memcpy(words + 1, participant.data() + 8, 4);
  std::memcpy(reinterpret_cast<unsigned char*>(words + 1) + 4, entity.data(), 4);
  std::uint64_t mixed = (words[0] ^ (words[1] * 0x9e3779b97f4a7c15U)) * 0xff51afd7ed558ccdU;
  mixed ^= mixed >> 32U;
  return static_cast<std::size_t>(mixed);
}

}  // namespace

double SequenceWindow::Writer::interval_ns() const {
  return samples > 0.0 ? std::max(samples_span_ns / samples, kShortestInterval_ns) : kShortestInterval_ns;
}

bool SequenceWindow::Writer::admit(std::uint32_t number, std::int64_t now_ns) {
  if (number <= newest) return true;
  const std::uint32_t ahead = number - newest;
  const auto passed_ns = static_cast<double>(now_ns - heard_ns);
  const double expected = passed_ns / interval_ns();
  const bool may_burst = is_builtin(entity) || now_ns - met_ns < kFirstContact_ns;
  const std::uint32_t burst = may_burst ? kFirstBurst : kSampleBurst;
  if (ahead > burst + kRateMargin * expected + behind) {
    agreeing = number >= refused && number - refused <= kSampleBurst ? agreeing + 1 : 1;
    refused = number;
    if (agreeing < kAgreeingDatagrams) return false;
    behind = 0.0;
  } else {
    // Nothing is known of the rate of a writer that was heard once.
    const double missing = samples == 0.0 ? 0.0 : std::min(expected, kCatchUp_ns / interval_ns()) - ahead;
    behind = std::max(0.0, behind * std::max(0.0, 1.0 - passed_ns / kCatchUp_ns) + missing);
    const double kept = kAveraged_ns / (kAveraged_ns + passed_ns);
    samples = kept * samples + ahead;
    samples_span_ns = kept * samples_span_ns + passed_ns;
  }
  newest = number;
  heard_ns = now_ns;
  agreeing = 0;
  return true;
}

bool SequenceWindow::admit(const GuidPrefix& participant, const EntityId& entity, std::uint32_t number,
                           std::int64_t now_ns) {
  const std::size_t first = hash(participant, entity);
  Writer* longest_silent = nullptr;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    Writer& writer = writers_[(first + i) & (kWriters - 1)];
    if (writer.entity == entity && writer.participant == participant) return writer.admit(number, now_ns);
    if (longest_silent == nullptr || writer.heard_ns < longest_silent->heard_ns) longest_silent = &writer;
  }
  *longest_silent = {participant, entity, number, now_ns, now_ns};
  return true;
}

}  // namespace swiftlet::comms

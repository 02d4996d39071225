#include "swiftlet/services/dds/datagram/sequence_window.hpp"

#include <algorithm>

namespace swiftlet::comms {
namespace {

constexpr double kShortestInterval_ns = 50e3;  // also of a writer that was heard once
constexpr double kAveraged_ns = 0.25e9;        // in which the usual rate is measured
constexpr double kRateMargin = 4.0;
// A writer has become slower when so many samples came late for so long, without two that came at once: a backlog.
constexpr int kLateSamples = 8;
constexpr std::int64_t kSlower_ns = 1'000'000'000;

}  // namespace

double SequenceWindow::Writer::interval_ns() const {
  return samples > 0.0 ? std::max(samples_span_ns / samples, kShortestInterval_ns) : kShortestInterval_ns;
}

std::uint32_t SequenceWindow::burst_of(const Writer& writer, std::int64_t now_ns) const {
  const bool builtin = is_builtin(writer.entity);
  if (builtin && discovery_servers_ && is_discovery_server(writer.participant)) return kServerBurst;
  return builtin || now_ns - writer.met_ns < kFirstContact_ns ? kFirstBurst : kSampleBurst;
}

bool SequenceWindow::Writer::admit(std::uint32_t number, std::int64_t now_ns, std::uint32_t burst) {
  if (number <= newest) return true;
  const double expected = timely + static_cast<double>(now_ns - timely_ns) / interval_ns() * kRateMargin;
  if (number > std::max<double>(newest, expected) + burst) {
    agreeing = number >= refused && number - refused <= kSampleBurst ? agreeing + 1 : 1;
    refused = number;
    if (agreeing < kAgreeingDatagrams) return false;
    timely = number;
    timely_ns = now_ns;
    late = 0;
  }
  const auto silent_ns = static_cast<double>(now_ns - heard_ns);
  newest = number;
  heard_ns = now_ns;
  agreeing = 0;
  measure_rate(silent_ns);
  return true;
}

void SequenceWindow::Writer::measure_rate(double silent_ns) {
  const auto passed_ns = static_cast<double>(heard_ns - timely_ns);
  const std::uint32_t sent = newest - timely;
  if (samples > 0.0 && sent + kSampleBurst / 2 < passed_ns / interval_ns()) {
    const bool backlog = silent_ns < interval_ns() / kRateMargin;
    if (late == 0 || backlog) {
      late = 0;
      late_since_ns = heard_ns;
    }
    if (++late < kLateSamples || heard_ns - late_since_ns < kSlower_ns) return;
  }
  const double kept = kAveraged_ns / (kAveraged_ns + passed_ns);
  samples = kept * samples + sent;
  samples_span_ns = kept * samples_span_ns + passed_ns;
  timely = newest;
  timely_ns = heard_ns;
  late = 0;
}

bool SequenceWindow::admit(const GuidPrefix& participant, const EntityId& entity, std::uint32_t number,
                           std::int64_t now_ns) {
  const std::size_t first = hash_of(participant, entity);
  Writer* longest_silent = nullptr;
  for (std::size_t i = 0; i < kPlaces; ++i) {
    Writer& writer = writers_[(first + i) & (kWriters - 1)];
    if (writer.entity == entity && writer.participant == participant)
      return writer.admit(number, now_ns, burst_of(writer, now_ns));
    if (longest_silent == nullptr || writer.heard_ns < longest_silent->heard_ns) longest_silent = &writer;
  }
  *longest_silent = {participant, entity, number, now_ns, now_ns, number, now_ns};
  return true;
}

}  // namespace swiftlet::comms

// Refuses sequence numbers that a writer cannot have reached yet. A reader ignores all samples below the highest number
// that it has seen: one changed bit in a copied datagram would silence a stream.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/services/dds/datagram/check.hpp"
#include "swiftlet/services/dds/datagram/rtps_ids.hpp"

namespace swiftlet::comms {

// A writer may be ahead by this many samples of the newest one that was heard, and of four times as many as it sends at its
// usual rate in the time since the reader last kept up with it: after a stall of the reader, what the socket kept is read
// within microseconds, and what did not fit into it is missing.
constexpr std::uint32_t kSampleBurst = 8;
// At first, while a reader learns what the writer has sent before; and of the middleware's own writers at all times. A
// process of many vehicles announces hundreds of endpoints at once, and a refused announcement is repeated after seconds.
constexpr std::uint32_t kFirstBurst = 1024;
// Of the middleware's own writers in a discovery server, which number what they tell all of its clients: each client hears
// only of a part.
constexpr std::uint32_t kServerBurst = kLongestBuiltinGap;
constexpr std::int64_t kFirstContact_ns = 2'000'000'000;
// As many datagrams in a row with numbers that are beyond, but agree with each other, show that the writer is there.
constexpr int kAgreeingDatagrams = 4;

// Remembers a fixed number of writers; beyond that, it forgets writers that have been silent for long. Allocates only when
// constructed. Not thread-safe.
class SequenceWindow {
 public:
  // discovery_servers: some participants are such servers.
  explicit SequenceWindow(bool discovery_servers = false)
      : discovery_servers_(discovery_servers), writers_(kWriters) {}

  // Returns whether the writer may have this number now, and remembers it. now_ns: of a monotonic clock.
  bool admit(const GuidPrefix& participant, const EntityId& entity, std::uint32_t number,
             std::int64_t now_ns);

 private:
  static constexpr std::size_t kWriters = 4096;  // a power of two
  static constexpr std::size_t kPlaces = 8;      // in which a writer may be stored

  struct Writer {
    GuidPrefix participant{};
    EntityId entity{};
    std::uint32_t newest = 0;
    std::int64_t met_ns = 0;  // heard for the first time
    std::int64_t heard_ns = 0;
    // The newest sample that came no later than the usual rate lets expect. Stalls of the reader delay samples, and lose
    // some, but nothing is heard before it was sent: those that followed such a sample soon tell the rate of the writer.
    std::uint32_t timely = 0;
    std::int64_t timely_ns = 0;
    int late = 0;  // samples in a row that came later than that
    std::int64_t late_since_ns = 0;
    double samples = 0.0;  // lately, and in how long
    double samples_span_ns = 0.0;
    std::uint32_t refused = 0;  // the last refused number
    int agreeing = 0;           // refused numbers in a row that agree with each other

    double interval_ns() const;
    bool admit(std::uint32_t number, std::int64_t now_ns, std::uint32_t burst);
    void measure_rate(double silent_ns);  // before the newest sample
  };

  std::uint32_t burst_of(const Writer& writer, std::int64_t now_ns) const;

  const bool discovery_servers_;
  std::vector<Writer> writers_;
};

}  // namespace swiftlet::comms

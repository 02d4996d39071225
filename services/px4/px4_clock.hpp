// Stamps of PX4 on the clock of this host.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace swiftlet::px4 {

// PX4 stamps by the clock of its agent, which it estimates: the stamps lag by tens to hundreds of ms, drift, and are set. The
// sample that was fastest on its way relates them to this host; the samples between keep PX4's intervals. Samples that are late by
// the same, in a row, begin anew. Does not allocate.
class Px4Clock {
 public:
  // The host's time of a sample with PX4's stamp, which arrived at arrived_ns. At most arrived_ns, and later than the last.
  std::int64_t to_host(std::uint64_t stamp_us, std::int64_t arrived_ns);
  int steps() const { return steps_; }  // how often PX4's stamps were set

 private:
  static constexpr std::size_t kWindow = 16;  // of parts of kPartNs
  static constexpr std::int64_t kPartNs = 31'250'000;

  void restart(std::int64_t delay_ns, std::int64_t arrived_ns);

  // The least of arrival minus stamp in each part of the last half second.
  std::array<std::int64_t, kWindow> least_ns_{};
  std::size_t part_ = 0;
  std::int64_t part_begin_ns_ = 0;
  bool is_started_ = false;
  int away_ = 0;  // samples in a row that do not fit, and that agree with each other
  std::int64_t least_away_ns_ = 0;
  std::int64_t most_away_ns_ = 0;
  int steps_ = 0;
  std::int64_t last_ns_ = 0;
};

}  // namespace swiftlet::px4

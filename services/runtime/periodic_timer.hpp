// A period kept by absolute times of the monotonic clock: no drift.
#pragma once

#include <cstdint>

namespace swiftlet::runtime {

std::int64_t monotonic_ns() noexcept;

class PeriodicTimer {
 public:
  // period_ns > 0. A tick that comes more than max_lateness_ns after its time is not made up for: the ticks
  // that follow are put off by as much as it is late. Smaller delays are made up for by ticks that follow at
  // once.
  PeriodicTimer(std::int64_t period_ns, std::int64_t max_lateness_ns);

  // Sleeps to the next tick, the first one period after construction. Returns by how much the ticks were put
  // off, ns.
  std::int64_t wait() noexcept;

 private:
  std::int64_t period_ns_;
  std::int64_t max_lateness_ns_;
  std::int64_t next_ns_;
};

}  // namespace swiftlet::runtime

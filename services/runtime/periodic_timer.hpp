// A periodic timer with absolute times of the monotonic clock: no drift.
#pragma once

#include <cstdint>

namespace swiftlet::runtime {

std::int64_t monotonic_ns() noexcept;
std::int64_t system_ns() noexcept;  // system clock, since 1970

class PeriodicTimer {
 public:
  // Ticks are whole periods after origin_ns, monotonic. period_ns > 0. If a tick is late by more than
  // max_lateness_ns, those are left out that are late by a period and more. After smaller delays the timer
  // catches up: late ticks follow at once.
  PeriodicTimer(std::int64_t period_ns, std::int64_t max_lateness_ns,
                std::int64_t origin_ns = monotonic_ns());

  // Sleeps until the next tick; the first is at most one period after construction. Returns the time of the ticks
  // that were left out, ns.
  std::int64_t wait() noexcept;
  // Monotonic time of the last tick; before the first, that of the tick before it.
  std::int64_t tick_ns() const noexcept { return next_ns_; }

 private:
  std::int64_t period_ns_;
  std::int64_t max_lateness_ns_;
  std::int64_t next_ns_;
};

}  // namespace swiftlet::runtime

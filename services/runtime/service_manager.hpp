// Tells a service manager, such as systemd, how this process is, by the protocol of sd_notify(3). Without a service manager
// nothing is sent.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::runtime {

// Sends a line such as "READY=1" to the socket that $NOTIFY_SOCKET names. Never waits; what cannot be sent is lost.
void notify_service_manager(std::string_view line) noexcept;

// Shows whether a loop goes on: the loop calls beat() each time, another thread asks.
class Pulse {
 public:
  // A loop that has not beaten for this long hangs.
  static constexpr std::int64_t kStillNs = 1'000'000'000;

  void beat() noexcept { beaten_ns_.store(monotonic_ns(), std::memory_order_relaxed); }
  bool beats() const noexcept {
    return monotonic_ns() - beaten_ns_.load(std::memory_order_relaxed) < kStillNs;
  }

 private:
  std::atomic<std::int64_t> beaten_ns_{monotonic_ns()};
};

// Feeds the watchdog of the service manager, at most each 200 ms: call at least that often while all goes on.
class Watchdog {
 public:
  void feed() noexcept;

 private:
  static constexpr std::int64_t kPeriodNs = 200'000'000;
  std::int64_t due_ns_ = 0;
};

}  // namespace swiftlet::runtime

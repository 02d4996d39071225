// Turns SIGINT and SIGTERM into a stop request.
#pragma once

#include <atomic>
#include <chrono>

namespace swiftlet::runtime {

class StopSignal {
 public:
  // Blocks both signals for the calling thread and its future threads: construct it before any other thread.
  // One per process. Throws std::system_error.
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // Requests a stop without a signal. Thread-safe.
  void request() noexcept;
  bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

  // Returns true once a stop was requested, false when the time has passed. Not thread-safe.
  bool wait_for(std::chrono::milliseconds time) noexcept;
  void wait() noexcept;

 private:
  bool poll_for(int milliseconds) noexcept;

  std::atomic<bool> requested_{false};
  int signal_fd_ = -1;
  int event_fd_ = -1;
};

}  // namespace swiftlet::runtime

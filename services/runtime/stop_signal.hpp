// SIGINT and SIGTERM as a request to end.
#pragma once

#include <atomic>
#include <chrono>

namespace swiftlet::runtime {

class StopSignal {
 public:
  // Blocks both signals for the calling thread and those that it makes: construct it before any thread. One a
  // process. Throws std::system_error.
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // From any thread, also in a signal's stead.
  void request() noexcept;
  bool requested() const noexcept { return requested_.load(std::memory_order_relaxed); }

  // By one thread. True once a stop was requested; otherwise false when the time has passed.
  bool wait_for(std::chrono::milliseconds time) noexcept;
  void wait() noexcept;

 private:
  bool poll_for(int milliseconds) noexcept;

  std::atomic<bool> requested_{false};
  int signal_fd_ = -1;
  int event_fd_ = -1;
};

}  // namespace swiftlet::runtime

// Starts several flights at the same time and ends all when one fails.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

namespace swiftlet::ground {

// Thread-safe.
class StartBarrier {
 public:
  explicit StartBarrier(std::size_t flights) : awaited_(flights) {}

  // Call when a flight is ready to start.
  void ready();
  // Returns true when all flights are ready and none has failed; false after the time-out or if one has
  // failed.
  bool wait_for_all(std::chrono::milliseconds timeout);

  // Call when a flight fails. sentence: names the vehicle and the reason; the first one is kept.
  void fail(const std::string& sentence);
  std::optional<std::string> failure() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t awaited_;
  std::optional<std::string> failure_;
};

}  // namespace swiftlet::ground

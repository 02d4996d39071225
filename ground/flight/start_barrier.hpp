// Starts several flights at the same time and ends all when one fails.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>

namespace swiftlet::ground {

// Thread-safe.
class StartBarrier {
 public:
  explicit StartBarrier(std::size_t flights) : awaited_(flights) {}

  // Call when a flight is ready to start. now_ns: on the common clock of the flights.
  void ready(std::int64_t now_ns = 0);
  // Returns true when all flights are ready and none has failed; false after the time-out or if one has
  // failed.
  bool wait_for_all(std::chrono::milliseconds timeout);
  // The time at which the last flight became ready, on the common clock.
  std::int64_t ready_ns() const;

  // Call when a flight fails. sentence: names the vehicle and the reason; the first one is kept.
  void fail(const std::string& sentence);
  std::optional<std::string> failure() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t awaited_;
  std::int64_t ready_ns_ = 0;
  std::optional<std::string> failure_;
};

}  // namespace swiftlet::ground

// Flights that begin at one time, and of which none goes on alone when another one has failed.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <optional>
#include <string>

namespace swiftlet::ground {

// Any thread may call it.
class StartBarrier {
 public:
  explicit StartBarrier(std::size_t flights) : awaited_(flights) {}

  // One more is ready to begin.
  void ready();
  // True as soon as all are ready and none has failed; false if it is not so within the time, or one has
  // failed.
  bool wait_for_all(std::chrono::milliseconds timeout);

  // A flight has failed: a sentence that names the vehicle. The first is kept.
  void fail(const std::string& sentence);
  std::optional<std::string> failure() const;

 private:
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t awaited_;
  std::optional<std::string> failure_;
};

}  // namespace swiftlet::ground

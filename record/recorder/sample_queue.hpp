// The samples on their way from the threads that receive them to the one that writes them.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::record {

// Bounded: what does not fit is refused, and the receiver goes on. put() copies the payload under a mutex that nobody
// holds for longer than such a copy, and does not allocate.
class SampleQueue {
 public:
  explicit SampleQueue(std::size_t capacity_bytes);

  // Thread-safe. Returns false if there is no room.
  bool put(const mcap::Message& message);

  // Waits until there is much to do or the time has passed, then calls use for each sample that was put. From one
  // thread.
  void take_all(std::chrono::milliseconds wait, const std::function<void(const mcap::Message&)>& use);

 private:
  const std::size_t capacity_;
  std::mutex mutex_;  // guards filling_
  std::condition_variable much_to_do_;
  std::vector<std::uint8_t> filling_;
  std::vector<std::uint8_t> emptying_;
};

}  // namespace swiftlet::record

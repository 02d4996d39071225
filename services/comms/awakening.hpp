// A process that was stopped for long (a debugger, a suspended machine) and goes on.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace swiftlet::comms {

// Looks at the clock in a thread of its own. When that was kept from it for longer than `absence`, the process was stopped, and
// `on_return` is called with how long it was away; once more with each look that follows while it returns false.
class Awakening {
 public:
  using OnReturn = std::function<bool(std::chrono::milliseconds away)>;

  Awakening(std::chrono::milliseconds absence, OnReturn on_return);
  ~Awakening();  // waits for on_return
  Awakening(const Awakening&) = delete;
  Awakening& operator=(const Awakening&) = delete;

  static constexpr int kLooks = 8;  // in an absence

 private:
  void watch();

  const std::chrono::milliseconds absence_;
  const OnReturn on_return_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace swiftlet::comms

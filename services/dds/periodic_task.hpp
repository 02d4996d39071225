// A thread that looks at something now and then.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace swiftlet::comms {

class PeriodicTask {
 public:
  // look() is called once each period.
  PeriodicTask(std::chrono::milliseconds period, std::function<void()> look)
      : period_(period), look_(std::move(look)), thread_([this] { watch(); }) {}
  // Ends at once, or with the look that is under way.
  ~PeriodicTask() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = true;
    }
    ended_.notify_one();
    thread_.join();
  }
  PeriodicTask(const PeriodicTask&) = delete;
  PeriodicTask& operator=(const PeriodicTask&) = delete;

 private:
  void watch() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!ended_.wait_for(lock, period_, [this] { return end_; })) {
      lock.unlock();
      look_();
      lock.lock();
    }
  }

  const std::chrono::milliseconds period_;
  const std::function<void()> look_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool end_ = false;
  std::thread thread_;
};

}  // namespace swiftlet::comms

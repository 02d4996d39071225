// A thread that looks at something now and then.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace swiftlet::comms {

class Lookout {
 public:
  // look() is called once each period.
  Lookout(std::chrono::milliseconds period, std::function<void()> look)
      : period_(period), look_(std::move(look)), thread_([this] { watch(); }) {}
  // Ends at once, or with the look that is under way.
  ~Lookout() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      end_ = true;
    }
    ended_.notify_one();
    thread_.join();
  }
  Lookout(const Lookout&) = delete;
  Lookout& operator=(const Lookout&) = delete;

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

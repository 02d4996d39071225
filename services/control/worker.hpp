// A thread of ordinary priority for tasks that take longer than a real-time thread may.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>

#include "swiftlet/services/runtime/log_label.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::services {

class Worker {
 public:
  static constexpr std::size_t kMostWaiting = 8;

  Worker() : thread_([this] { run(); }) {}
  // Waits for the running task; those that wait are dropped.
  ~Worker() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  // Runs the tasks in their order, which must not throw. Waits while kMostWaiting others wait.
  void post(std::function<void()> task) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return waiting_.size() < kMostWaiting; });
    waiting_.push_back(std::move(task));
    lock.unlock();
    changed_.notify_all();
  }

 private:
  void run() {
    runtime::make_this_thread_ordinary();
    const runtime::LogLabel label(label_);
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      changed_.wait(lock, [this] { return ends_ || !waiting_.empty(); });
      if (ends_) return;
      const std::function<void()> task = std::move(waiting_.front());
      waiting_.pop_front();
      lock.unlock();
      changed_.notify_all();
      task();
      lock.lock();
    }
  }

  const std::string label_ = runtime::LogLabel::current();  // of the thread that constructs it
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool ends_ = false;
  std::thread thread_;  // last: uses all members above
};

}  // namespace swiftlet::services

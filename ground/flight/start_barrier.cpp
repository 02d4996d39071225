#include "swiftlet/ground/flight/start_barrier.hpp"

#include <algorithm>

namespace swiftlet::ground {

void StartBarrier::ready(std::int64_t now_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  ready_ns_ = std::max(ready_ns_, now_ns);
  --awaited_;
  changed_.notify_all();
}

bool StartBarrier::wait_for_all(std::chrono::milliseconds timeout) {
  std::unique_lock<std::mutex> lock(mutex_);
  changed_.wait_for(lock, timeout, [this] { return awaited_ == 0 || failure_; });
  return awaited_ == 0 && !failure_;
}

std::int64_t StartBarrier::ready_ns() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return ready_ns_;
}

void StartBarrier::fail(const std::string& sentence) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!failure_) failure_ = sentence;
  changed_.notify_all();
}

std::optional<std::string> StartBarrier::failure() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return failure_;
}

}  // namespace swiftlet::ground

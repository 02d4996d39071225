// Waiting for a predicate with a deadline.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace swiftlet::tests {

// What takes longer hangs. It is no bound on how fast something is: a busy machine may stall for half a minute.
constexpr std::chrono::seconds kStuck{300};

// Returns true as soon as the predicate holds, false after the timeout. For sources that cannot notify, such
// as another process: evaluates it every `period`, and once more after the timeout even if this thread was
// delayed.
inline bool eventually(const std::function<bool()>& predicate, std::chrono::milliseconds timeout = kStuck,
                       std::chrono::milliseconds period = std::chrono::milliseconds(1)) {
  const auto give_up = std::chrono::steady_clock::now() + timeout;
  for (bool is_last = false; !predicate(); is_last = std::chrono::steady_clock::now() > give_up) {
    if (is_last) return false;
    std::this_thread::sleep_for(period);
  }
  return true;
}

// Collects items from callbacks in other threads.
template <class T>
class Inbox {
 public:
  void put(T item) {
    const std::lock_guard<std::mutex> lock(mutex_);
    items_.push_back(std::move(item));
    changed_.notify_all();
  }
  std::vector<T> items() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return items_;
  }
  std::size_t size() const { return items().size(); }
  void clear() {
    const std::lock_guard<std::mutex> lock(mutex_);
    items_.clear();
  }

  // Returns true as soon as the predicate holds for the items, false after the timeout.
  bool wait(const std::function<bool(const std::vector<T>&)>& predicate,
            std::chrono::milliseconds timeout = kStuck) const {
    std::unique_lock<std::mutex> lock(mutex_);
    return changed_.wait_for(lock, timeout, [&] { return predicate(items_); });
  }
  bool wait_for_count(std::size_t count) const {
    return wait([count](const std::vector<T>& items) { return items.size() >= count; });
  }

 private:
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  std::vector<T> items_;
};

}  // namespace swiftlet::tests

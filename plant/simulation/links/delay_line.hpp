// Delay line: holds items in order until they are due. It allocates memory only at construction.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace swiftlet::plant {

template <class Item>
class DelayLine {
 public:
  // capacity: largest number of items. When the line is full, put() drops the oldest item.
  explicit DelayLine(std::size_t capacity) : items_(std::max<std::size_t>(capacity, 1)) {}

  // Adds an item that arrives at due_ns, or together with the one before it if that is later: take() keeps the order.
  void put(const Item& item, std::int64_t due_ns) {
    if (count_ == items_.size()) drop_oldest();
    Held& held = at(count_++);
    held.item = item;
    held.due_ns = due_ns;
  }

  // Returns the newest item that is due at now_ns, if any. Older items are dropped.
  std::optional<Item> take(std::int64_t now_ns) {
    std::optional<Item> newest;
    while (count_ > 0 && at(0).due_ns <= now_ns) {
      newest = at(0).item;
      drop_oldest();
    }
    return newest;
  }

  // Returns the oldest item, if it is due at now_ns; else null. It stays valid until the next put().
  const Item* take_oldest(std::int64_t now_ns) {
    if (count_ == 0 || at(0).due_ns > now_ns) return nullptr;
    const Item& oldest = at(0).item;
    drop_oldest();
    return &oldest;
  }

  void clear() { count_ = 0; }
  bool empty() const { return count_ == 0; }

 private:
  struct Held {
    Item item;
    std::int64_t due_ns;
  };

  std::size_t wrapped(std::size_t i) const { return i < items_.size() ? i : i - items_.size(); }
  Held& at(std::size_t i) { return items_[wrapped(oldest_ + i)]; }
  void drop_oldest() {
    oldest_ = wrapped(oldest_ + 1);
    --count_;
  }

  std::vector<Held> items_;
  std::size_t oldest_ = 0;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::plant

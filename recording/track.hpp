// Append-only record that one thread writes while others read.
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <new>
#include <type_traits>

namespace swiftlet::ground {

// Rows in order of arrival. One thread appends without waiting. Any thread may read the rows appended so far.
// When the track is full, further rows are dropped.
template <class Row>
class Track {
 public:
  // Reserves the memory. The system provides a page of it when its first row is written.
  explicit Track(std::size_t capacity)
      : rows_(std::allocator<Row>().allocate(capacity), Free{capacity}), capacity_(capacity) {}

  void append(const Row& row) noexcept {
    const std::size_t at = size_.load(std::memory_order_relaxed);
    if (at == capacity_) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
    ::new (rows_.get() + at) Row(row);
    size_.store(at + 1, std::memory_order_release);
  }

  void clear() noexcept {  // only while no thread reads
    size_.store(0, std::memory_order_release);
    dropped_.store(0, std::memory_order_relaxed);
  }

  std::size_t size() const { return size_.load(std::memory_order_acquire); }
  std::size_t dropped() const { return dropped_.load(std::memory_order_relaxed); }  // rows, since clear()
  bool empty() const { return size() == 0; }
  const Row& operator[](std::size_t i) const { return rows_.get()[i]; }
  const Row& back() const { return rows_.get()[size() - 1]; }
  const Row* begin() const { return rows_.get(); }
  const Row* end() const { return rows_.get() + size(); }

 private:
  static_assert(std::is_trivially_destructible_v<Row>);
  struct Free {
    std::size_t capacity = 0;
    void operator()(Row* rows) const { std::allocator<Row>().deallocate(rows, capacity); }
  };

  std::unique_ptr<Row, Free> rows_;
  std::size_t capacity_;
  std::atomic<std::size_t> size_{0};
  std::atomic<std::size_t> dropped_{0};
};

}  // namespace swiftlet::ground

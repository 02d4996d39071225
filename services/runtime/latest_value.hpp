// Passes the newest value from one thread to another, wait-free on both sides.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>

namespace swiftlet::runtime {

// One thread calls put(), one thread calls take(). Three slots rotate: the writer's, the reader's, and a
// middle one that each side swaps with its own by an atomic exchange. T is copied by assignment, which must
// not throw.
template <class T>
class LatestValue {
 public:
  void put(const T& value) noexcept {
    slots_[writer_slot_].value = value;
    writer_slot_ = middle_.exchange(writer_slot_ | kFresh, std::memory_order_acq_rel) & kSlot;
  }

  // Returns true if a value was put since the last call, and copies the newest one to value.
  bool take(T& value) noexcept {
    if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0) return false;
    reader_slot_ = middle_.exchange(reader_slot_, std::memory_order_acq_rel) & kSlot;
    value = slots_[reader_slot_].value;
    return true;
  }

 private:
  static constexpr std::uint8_t kSlot = 3;
  static constexpr std::uint8_t kFresh = 4;
  static constexpr std::size_t kCacheLine = 64;

  struct alignas(kCacheLine) Slot {
    T value{};
  };
  std::array<Slot, 3> slots_;
  alignas(kCacheLine) std::uint8_t writer_slot_ = 0;
  alignas(kCacheLine) std::atomic<std::uint8_t> middle_{1};
  alignas(kCacheLine) std::uint8_t reader_slot_ = 2;
};

}  // namespace swiftlet::runtime

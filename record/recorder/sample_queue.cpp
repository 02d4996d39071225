#include "swiftlet/record/recorder/sample_queue.hpp"

#include <cstring>

namespace swiftlet::record {
namespace {

// Two buffers take turns: one is filled while the other is emptied.
constexpr std::size_t kBuffers = 2;
constexpr std::size_t kMuch = 4;  // a buffer is emptied early when this part of it is full

}  // namespace

SampleQueue::SampleQueue(std::size_t capacity_bytes) : capacity_(capacity_bytes / kBuffers) {
  filling_.reserve(capacity_);
  emptying_.reserve(capacity_);
}

bool SampleQueue::put(const mcap::Message& message) {
  const auto* const head = reinterpret_cast<const std::uint8_t*>(&message);
  const std::size_t needed = sizeof(message) + message.payload.size;
  bool much = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::size_t before = filling_.size();
    if (capacity_ - before < needed) return false;
    filling_.insert(filling_.end(), head, head + sizeof(message));
    filling_.insert(filling_.end(), message.payload.data, message.payload.data + message.payload.size);
    much = before < capacity_ / kMuch && filling_.size() >= capacity_ / kMuch;
  }
  if (much) much_to_do_.notify_one();
  return true;
}

void SampleQueue::take_all(std::chrono::milliseconds wait,
                           const std::function<void(const mcap::Message&)>& use) {
  {
    std::unique_lock<std::mutex> lock(mutex_);
    much_to_do_.wait_for(lock, wait, [&] { return filling_.size() >= capacity_ / kMuch; });
    filling_.swap(emptying_);
  }
  for (std::size_t at = 0; at < emptying_.size();) {
    mcap::Message message;
    std::memcpy(&message, emptying_.data() + at, sizeof(message));
    at += sizeof(message);
    message.payload.data = emptying_.data() + at;
    at += message.payload.size;
    use(message);
  }
  emptying_.clear();
}

}  // namespace swiftlet::record

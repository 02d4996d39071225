// Selects one of several sources of a stream.
#pragma once

#include <chrono>
#include <optional>

namespace swiftlet::dds {

// Accepts the samples of the source that was heard first, until it has been silent for a time. Then the next
// source that is heard takes its place. Not thread-safe. Does not allocate.
template <class Id>
class SingleSource {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit SingleSource(std::chrono::milliseconds silence) : silence_(silence) {}

  // Returns true if a sample that `id` sent is accepted.
  bool accepts(const Id& id, Time now) {
    if (id_ && !(*id_ == id) && now - heard_ < silence_) return false;
    id_ = id;
    heard_ = now;
    return true;
  }

  const std::optional<Id>& id() const { return id_; }

 private:
  std::chrono::milliseconds silence_;
  std::optional<Id> id_;
  Time heard_{};
};

}  // namespace swiftlet::dds

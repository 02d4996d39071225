// The messages on their way to one viewer.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "swiftlet/record/mcap/records.hpp"

namespace swiftlet::ground {

struct Frame {
  std::uint32_t subscription = 0;
  std::int64_t time_ns = 0;
  std::shared_ptr<const mcap::Bytes> payload;  // viewers share it
  bool is_event = false;                       // a newer one of the subscription does not replace it
};

// Which messages a viewer gets.
enum class Selection {
  kAll,     // each one, as long as it keeps up
  kNewest,  // in each round of the server the newest of each subscription, for a picture of the state
};

// Bounded: a viewer that does not keep up gets the newest message of each subscription, and the events, and loses
// what is older.
// Not thread-safe.
class FrameQueue {
 public:
  // most_bytes: of payloads that wait; a message that is larger than this is lost.
  FrameQueue(std::size_t most_bytes, Selection selection) : most_bytes_(most_bytes), selection_(selection) {}

  void put(Frame frame);
  // What is put from now on is of another round.
  void begin_round() { round_ += 1; }
  std::optional<Frame> take();  // the oldest
  void forget(std::uint32_t subscription);

  std::size_t size() const { return waiting_.size(); }
  // Messages that were lost because the viewer was slow; with kNewest not those that a newer one of the same round
  // replaced.
  std::uint64_t dropped() const { return dropped_; }

 private:
  struct Waiting {
    Frame frame;
    std::uint64_t round = 0;
  };
  void keep_newest();
  void remove(std::deque<Waiting>::iterator one);

  const std::size_t most_bytes_;
  const Selection selection_;
  std::deque<Waiting> waiting_;
  std::size_t bytes_ = 0;
  std::uint64_t round_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace swiftlet::ground

#include "swiftlet/ground/view/frame_queue.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace swiftlet::ground {

void FrameQueue::put(Frame frame) {
  const std::size_t needed = frame.payload->size();
  if (needed > most_bytes_) {
    ++dropped_;
    return;
  }
  if (selection_ == Selection::kNewest && !frame.is_event) {
    const auto older = std::find_if(waiting_.begin(), waiting_.end(), [&](const Waiting& one) {
      return one.frame.subscription == frame.subscription;
    });
    if (older != waiting_.end()) {
      if (older->round != round_) ++dropped_;
      remove(older);
    }
  }
  bytes_ += needed;
  waiting_.push_back({std::move(frame), round_});
  if (bytes_ > most_bytes_) keep_newest();
  while (bytes_ > most_bytes_) {
    ++dropped_;
    remove(waiting_.begin());
  }
}

void FrameQueue::keep_newest() {
  std::set<std::uint32_t> seen;
  std::deque<Waiting> newest;
  bytes_ = 0;
  for (auto one = waiting_.rbegin(); one != waiting_.rend(); ++one) {
    if (!seen.insert(one->frame.subscription).second && !one->frame.is_event) {
      ++dropped_;
      continue;
    }
    bytes_ += one->frame.payload->size();
    newest.push_front(std::move(*one));
  }
  waiting_ = std::move(newest);
}

void FrameQueue::remove(std::deque<Waiting>::iterator one) {
  bytes_ -= one->frame.payload->size();
  waiting_.erase(one);
}

std::optional<Frame> FrameQueue::take() {
  if (waiting_.empty()) return std::nullopt;
  Frame frame = waiting_.front().frame;
  remove(waiting_.begin());
  return frame;
}

void FrameQueue::forget(std::uint32_t subscription) {
  for (auto one = waiting_.begin(); one != waiting_.end();) {
    if (one->frame.subscription != subscription) {
      ++one;
      continue;
    }
    bytes_ -= one->frame.payload->size();
    one = waiting_.erase(one);
  }
}

}  // namespace swiftlet::ground

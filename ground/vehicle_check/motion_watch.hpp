// Follows guided motions of a hand by motion capture: each between rest and rest.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "swiftlet/ground/vehicle_check/hand_motion.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::ground {

class MotionWatch {
 public:
  // Begins to watch for this motion. Before the first, only rest is watched for.
  void expect(HandStep step);

  // Takes a tracked pose. Returns the segment once the expected motion has ended in rest.
  std::optional<HandSegment> update(const plant::PoseSample& pose, std::int64_t received_ns);

  bool is_ready() const { return begin_.has_value(); }  // it has rested, and may be moved

 private:
  struct Entry {
    plant::PoseSample pose;
    std::int64_t received_ns = 0;
  };

  bool is_still() const;
  bool has_moved(const Entry& now);

  std::optional<HandStep> step_;
  std::deque<Entry> window_;    // the last kStill_ns
  std::optional<Entry> begin_;  // the last rest before the motion
  bool moved_ = false;
  std::optional<std::int64_t> moving_since_ns_;
};

}  // namespace swiftlet::ground

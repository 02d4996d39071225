// What a motion capture sends of each body: how often, how late, and how often it is lost.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "swiftlet/services/mocap/sources/source.hpp"

namespace swiftlet::ground {

struct BodyStatistics {
  std::uint64_t frames = 0;  // in which it stands, also untracked
  std::uint64_t untracked = 0;
  std::uint64_t lost_markers = 0;  // of all frames
  std::uint64_t markers = 0;
  double latency_sum_s = 0.0;  // from the exposure to the arrival, over the frames whose exposure is known
  double latency_max_s = 0.0;
  std::uint64_t latencies = 0;
  double longest_gap_s = 0.0;  // between frames in which it is tracked
  std::optional<std::int64_t> tracked_ns;
  mocap::BodyPose last;

  double mean_latency_s() const {
    return latencies == 0 ? 0.0 : latency_sum_s / static_cast<double>(latencies);
  }
};

// One entry for each of source.bodies(), in their order. Begins anew when these change.
class BodyStatisticsList {
 public:
  void take(const mocap::SourceFrame& frame, const mocap::Source& source);
  const std::vector<BodyStatistics>& bodies() const { return bodies_; }
  void clear() { bodies_.assign(bodies_.size(), {}); }

 private:
  std::vector<BodyStatistics> bodies_;
  std::uint64_t revision_ = 0;
};

}  // namespace swiftlet::ground

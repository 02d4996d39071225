#include "swiftlet/ground/cli/mocap/body_statistics.hpp"

#include <algorithm>

namespace swiftlet::ground {

void BodyStatisticsList::take(const mocap::SourceFrame& frame, const mocap::Source& source) {
  if (source.revision() != revision_ || bodies_.size() != source.bodies().size())
    bodies_.assign(source.bodies().size(), {});
  revision_ = source.revision();
  for (const mocap::BodyPose& pose : frame.poses) {
    if (pose.body >= bodies_.size()) continue;
    BodyStatistics& body = bodies_[pose.body];
    ++body.frames;
    body.last = pose;
    body.markers += static_cast<std::uint64_t>(pose.markers);
    body.lost_markers += static_cast<std::uint64_t>(pose.lost_markers);
    if (frame.exposed_ns) {
      const double latency_s = 1e-9 * static_cast<double>(frame.arrived_ns - *frame.exposed_ns);
      body.latency_sum_s += latency_s;
      body.latency_max_s = std::max(body.latency_max_s, latency_s);
      ++body.latencies;
    }
    if (!pose.tracked) {
      ++body.untracked;
      continue;
    }
    if (body.tracked_ns)
      body.longest_gap_s =
          std::max(body.longest_gap_s, 1e-9 * static_cast<double>(frame.arrived_ns - *body.tracked_ns));
    body.tracked_ns = frame.arrived_ns;
  }
}

}  // namespace swiftlet::ground

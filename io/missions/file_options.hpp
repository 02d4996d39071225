// What a command says about a mission file or a file of another project, besides its name: how it is read, and where it is
// flown. Applied in this order: frame, heights (whole_flight.hpp), placement, time scale, fence.
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "swiftlet/io/missions/mission_frame.hpp"
#include "swiftlet/io/missions/placement.hpp"

namespace swiftlet::io {

// Two opposite corners, m in NED.
struct Fence {
  Eigen::Vector3d min_ned, max_ned;
};

struct FileOptions {
  std::optional<MissionFrame> frame;  // of a file that does not name its own
  // m, > 0: by how much a path may pass samples by, along each axis, and by how many rad in yaw. Without it, by half
  // of the last digit with which they are written.
  std::optional<double> tolerance_m;
  double time_scale = 1.0;  // > 0: the file is flown so many times as slow
  std::string columns =
      {};  // of a table, in place of its header: names in order, between commas; empty: none
  // Only the samples from and until this time are flown, s from the first row.
  std::optional<double> from_s = {}, until_s = {};
  Placement placement = {};
  std::optional<Fence> fence = {};  // inside that of the control settings, in place of the file's own
};

}  // namespace swiftlet::io

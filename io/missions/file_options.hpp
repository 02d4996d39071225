// What a command says about a file of another project, besides its name.
#pragma once

#include <optional>
#include <string>

#include "swiftlet/io/missions/mission_frame.hpp"

namespace swiftlet::ground {

struct FileOptions {
  std::optional<MissionFrame> frame;  // of a CSV file that does not name its own
  // m, > 0: by how much a path may pass samples by, along each axis, and by how many rad in yaw. Without it, by half
  // of the last digit with which they are written.
  std::optional<double> tolerance_m;
  double time_scale = 1.0;  // > 0: the file is flown so many times as slow
  std::string columns =
      {};  // of a table, in place of its header: names in order, between commas; empty: none
};

}  // namespace swiftlet::ground

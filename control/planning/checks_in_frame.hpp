// The checks of checks.hpp for a path of a file. They take places in NED too; the reason names them in the frame of the
// file, so that its author finds them there.
#pragma once

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/types/frame.hpp"

namespace swiftlet::control {

// What a reason calls the thing that is checked, and the frame of the places in it.
struct InFrame {
  const char* what;
  Frame frame;
};

Outcome check_position(InFrame named, const Eigen::Vector3d& position_ned, const Limits& limits);
Outcome check_height(InFrame named, double z_ned, const Limits& limits);
Outcome check_above_ground(InFrame named, double z_ned);
Outcome check_segment(InFrame named, const PolynomialSegment& segment, const Limits& limits);

}  // namespace swiftlet::control

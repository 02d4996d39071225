// The frames of positions and yaw angles in files, and their conversion to NED.
#pragma once

#include <cmath>
#include <string>

#include <Eigen/Core>

#include "swiftlet/control/types/frame.hpp"

namespace swiftlet::io {

using MissionFrame = control::Frame;
using control::frame_title;

// "ned", as options and the endings of columns have it.
inline const char* frame_name(MissionFrame frame) {
  return frame == MissionFrame::kNed ? "ned" : frame == MissionFrame::kEnu ? "enu" : "nwu";
}

// "in NED", what the checks call a place.
inline std::string in_frame(MissionFrame frame) { return std::string("in ") + frame_title(frame); }

// Turns a position, velocity or acceleration.
inline Eigen::Vector3d ned_from(MissionFrame frame, const Eigen::Vector3d& vector) {
  switch (frame) {
    case MissionFrame::kEnu:
      return {vector.y(), vector.x(), -vector.z()};
    case MissionFrame::kNwu:
      return {vector.x(), -vector.y(), -vector.z()};
    case MissionFrame::kNed:
      break;
  }
  return vector;
}

// The yaw is not wrapped: turns of a continuous yaw are kept.
inline double ned_yaw_from(MissionFrame frame, double yaw_rad) {
  switch (frame) {
    case MissionFrame::kEnu:
      return M_PI / 2 - yaw_rad;
    case MissionFrame::kNwu:
      return -yaw_rad;
    case MissionFrame::kNed:
      break;
  }
  return yaw_rad;
}

inline double ned_yaw_rate_from(MissionFrame frame, double yaw_rate) {
  return frame == MissionFrame::kNed ? yaw_rate : -yaw_rate;
}

}  // namespace swiftlet::io

// The frames in which files state places.
#pragma once

namespace swiftlet::control {

// kNed: x north, y east, z down; yaw clockwise from north. kEnu: x east, y north, z up; yaw counter-clockwise
// from east. kNwu: x north, y west, z up; yaw counter-clockwise from north.
enum class Frame { kNed, kEnu, kNwu };

// "NED", for sentences.
inline const char* frame_title(Frame frame) {
  return frame == Frame::kNed ? "NED" : frame == Frame::kEnu ? "ENU" : "NWU";
}

}  // namespace swiftlet::control

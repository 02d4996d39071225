// Sticks that are moved by the keys of a terminal. A terminal reports no release of a key: a key counts as
// held while it repeats.
#pragma once

#include <array>
#include <cstdint>

#include "swiftlet/ground/teleop/sticks.hpp"

namespace swiftlet::ground {

enum class StickKey : std::uint8_t { kForward, kBack, kLeft, kRight, kUp, kDown, kTurnLeft, kTurnRight };

// The dead-man timeout: a key counts as released if it is not reported again for this time.
struct KeyTimeouts {
  double first_s = 0.7;    // after a key was pressed: keyboards begin to repeat after 0.25 to 0.66 s
  double repeat_s = 0.25;  // once it repeats
};

// Times are of any monotonic clock, s.
class KeySticks {
 public:
  explicit KeySticks(const KeyTimeouts& timeouts = {}) : timeouts_(timeouts) {}

  // The terminal reported the key: pressed, or repeated.
  void press(StickKey key, double now_s);
  void release_all() { axes_ = {}; }
  // Full deflection of each axis whose key is held.
  Sticks sticks(double now_s) const;

 private:
  struct Axis {
    double deflection = 0.0;  // -1, 0 or 1
    double held_until_s = 0.0;

    double at(double now_s) const { return now_s <= held_until_s ? deflection : 0.0; }
  };

  KeyTimeouts timeouts_;
  std::array<Axis, 4> axes_{};  // forward, right, up, turn
};

}  // namespace swiftlet::ground

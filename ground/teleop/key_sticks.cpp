#include "swiftlet/ground/teleop/key_sticks.hpp"

#include <cstddef>

namespace swiftlet::ground {
namespace {

struct Deflection {
  std::size_t axis;
  double value;
};

Deflection deflection_of(StickKey key) {
  switch (key) {
    case StickKey::kForward:
      return {0, 1.0};
    case StickKey::kBack:
      return {0, -1.0};
    case StickKey::kRight:
      return {1, 1.0};
    case StickKey::kLeft:
      return {1, -1.0};
    case StickKey::kUp:
      return {2, 1.0};
    case StickKey::kDown:
      return {2, -1.0};
    case StickKey::kTurnRight:
      return {3, 1.0};
    case StickKey::kTurnLeft:
      break;
  }
  return {3, -1.0};
}

}  // namespace

void KeySticks::press(StickKey key, double now_s) {
  const Deflection pressed = deflection_of(key);
  Axis& axis = axes_[pressed.axis];
  const bool repeats = axis.at(now_s) == pressed.value;
  axis = {pressed.value, now_s + (repeats ? timeouts_.repeat_s : timeouts_.first_s)};
}

Sticks KeySticks::sticks(double now_s) const {
  return {axes_[0].at(now_s), axes_[1].at(now_s), axes_[2].at(now_s), axes_[3].at(now_s)};
}

}  // namespace swiftlet::ground

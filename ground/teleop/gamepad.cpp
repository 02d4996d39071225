#include "swiftlet/ground/teleop/gamepad.hpp"

#include <algorithm>
#include <cmath>
#include <linux/input.h>
#include <stdexcept>

namespace swiftlet::ground {
namespace {

constexpr double kLeastDeadZone = 0.1;  // of full deflection: worn sticks do not return to their centre
constexpr double kMostDeadZone = 0.5;

bool is_dead_man_button(std::uint16_t code) {
  return code == BTN_TL || code == BTN_TR || code == BTN_TRIGGER;
}

}  // namespace

GamepadAxes usual_axes() { return {{ABS_X, {}}, {ABS_Y, {}}, {ABS_RX, {}}, {ABS_RY, {}}}; }

Gamepad::Gamepad(const GamepadAxes& axes) : axes_(axes) {
  const auto has = [this](int x, int y) { return axes_.count(x) > 0 && axes_.count(y) > 0; };
  const bool usual = has(ABS_RX, ABS_RY);
  if (!has(ABS_X, ABS_Y) || (!usual && !has(ABS_Z, ABS_RZ)))
    throw std::runtime_error("is not a gamepad with two sticks");
  right_x_ = usual ? ABS_RX : ABS_Z;
  right_y_ = usual ? ABS_RY : ABS_RZ;
}

void Gamepad::take(const input_event& event) {
  if (event.type == EV_SYN) {
    if (event.code == SYN_DROPPED) forget_state();
    losing_events_ = event.code == SYN_DROPPED || (losing_events_ && event.code != SYN_REPORT);
  } else if (losing_events_) {
    return;
  } else if (event.type == EV_ABS) {
    const auto axis = axes_.find(event.code);
    if (axis == axes_.end()) return;
    axis->second.value = event.value;
    axis->second.is_known = true;
  } else if (event.type == EV_KEY && is_dead_man_button(event.code)) {
    if (event.value != 0) {
      held_buttons_.insert(event.code);
    } else {
      held_buttons_.erase(event.code);
    }
  }
}

void Gamepad::forget_state() {
  release_buttons();
  for (auto& [code, axis] : axes_) axis.is_known = false;
}

double Gamepad::deflection(int code) const {
  const GamepadAxis& axis = axes_.at(code);
  const double centre = 0.5 * axis.minimum + 0.5 * axis.maximum;
  const double half = axis.maximum - centre;
  if (half <= 0.0 || !axis.is_known) return 0.0;
  const double value = std::clamp((axis.value - centre) / half, -1.0, 1.0);
  const double dead = std::clamp(axis.flat / half, kLeastDeadZone, kMostDeadZone);
  return std::copysign(std::max(std::abs(value) - dead, 0.0) / (1.0 - dead), value);
}

// Upwards and forwards are negative on an axis.
Sticks Gamepad::sticks() const {
  if (!enabled()) return {};
  return {-deflection(right_y_), deflection(right_x_), -deflection(ABS_Y), deflection(ABS_X)};
}

}  // namespace swiftlet::ground

// The sticks of a gamepad, from the events of the Linux input subsystem (evdev,
// https://docs.kernel.org/input/event-codes.html). Mode 2: the left stick climbs and turns, the right stick
// moves horizontally. The dead-man button: without a shoulder button that is held, all sticks are centred.
#pragma once

#include <cstdint>
#include <map>
#include <set>

#include "swiftlet/ground/teleop/sticks.hpp"

struct input_event;  // <linux/input.h>

namespace swiftlet::ground {

// An absolute axis, as the ioctl EVIOCGABS reports it.
struct GamepadAxis {
  int minimum = -32768;
  int maximum = 32767;
  int flat = 0;  // half the width of the dead zone
  int value = 0;
  bool is_known = true;  // false: events were lost since; it counts as centred until it moves
};

using GamepadAxes = std::map<int, GamepadAxis>;  // by code: ABS_X ...

// Two sticks with 16 bits an axis, as most gamepads have.
GamepadAxes usual_axes();

class Gamepad {
 public:
  // Throws std::runtime_error if the axes are not those of two sticks: ABS_X and ABS_Y, and ABS_RX and ABS_RY,
  // or ABS_Z and ABS_RZ.
  explicit Gamepad(const GamepadAxes& axes);

  // After lost events (SYN_DROPPED) the buttons count as released, and the axes as centred.
  void take(const input_event& event);
  void release_buttons() { held_buttons_.clear(); }

  bool enabled() const { return !held_buttons_.empty(); }  // a shoulder button (L1, R1) or trigger is held
  Sticks sticks() const;                                   // centred unless enabled

 private:
  void forget_state();
  double deflection(int code) const;  // -1 .. 1

  GamepadAxes axes_;
  int right_x_ = 0, right_y_ = 0;  // codes
  std::set<std::uint16_t> held_buttons_;
  bool losing_events_ = false;  // until the report that ends them
};

}  // namespace swiftlet::ground

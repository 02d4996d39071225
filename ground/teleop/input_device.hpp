// A gamepad as a file of events: /dev/input/event*, or a FIFO through which such events come.
#pragma once

#include <optional>
#include <string>

#include "swiftlet/ground/teleop/gamepad.hpp"

namespace swiftlet::ground {

class InputDevice {
 public:
  // Throws std::runtime_error, a sentence that names the file, if it cannot be opened or is not a gamepad. The
  // axes of a FIFO are usual_axes().
  explicit InputDevice(const std::string& path);
  ~InputDevice();
  InputDevice(const InputDevice&) = delete;
  InputDevice& operator=(const InputDevice&) = delete;

  // Takes the events that have arrived. Does not wait. Returns false once the device has been unplugged or the
  // FIFO's writer has closed it; the buttons then count as released.
  bool update();

  const Gamepad& gamepad() const { return *gamepad_; }
  const std::string& name() const { return name_; }  // the device's own name, or its path

 private:
  bool read_events();

  int fd_ = -1;
  std::string name_;
  std::string unread_;  // the first bytes of an event whose rest has not arrived
  std::optional<Gamepad> gamepad_;
};

}  // namespace swiftlet::ground

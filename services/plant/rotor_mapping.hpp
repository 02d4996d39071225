// From the actuator controls of an autopilot to the throttles of the rotors.
#pragma once

#include <array>
#include <cstddef>
#include <string>

#include "swiftlet/io/mavlink/messages.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::services {

class RotorMapping {
 public:
  // controls: "px4" for PX4's numbers of a quadrotor in X (1 front right, 2 rear left, 3 front left, 4 rear right),
  // "direct" where control i drives rotor i of the vehicle file, or a list such as "3,1,2,4": the number of the
  // control, from 1, of each rotor. Throws std::invalid_argument if they do not fit the vehicle.
  RotorMapping(const std::string& controls, double control_at_zero, double control_at_full,
               const plant::Vehicle& vehicle);

  // Rotor state and throttles: off unless armed, controls beyond the range are limited. A throttle is NaN if its
  // control is.
  plant::ActuatorCommand command(const mavlink::HilActuatorControls& controls) const;

 private:
  int rotor_count_;
  std::array<std::size_t, plant::kMaxRotors> control_of_rotor_{};
  double control_at_zero_;
  double control_range_;
};

// True if the rotors of a quadrotor in X turn as those of PX4's: the first two counter-clockwise.
bool spins_as_px4(const plant::Vehicle& vehicle);

}  // namespace swiftlet::services

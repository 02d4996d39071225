// What a controller must be given to go on with a flight where another one stopped: plain data. What the
// estimator and the rotor observer know is not part of it: each controller hears the same sensors.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/supervision/state.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

struct FlightState {
  SupervisorState supervisor;
  Eigen::Vector3d position_integral = Eigen::Vector3d::Zero();  // m/s^2, of acceleration in NED
  plant::RotorState rotor_state = plant::RotorState::kOff;      // of the last command, as what follows
  plant::PerRotor throttle{};
};

}  // namespace swiftlet::control

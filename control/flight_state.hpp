// The state of a flight, for another controller to continue it: plain data. The states of the estimator and
// the rotor observer are not part of it, because every controller receives the same sensor data.
#pragma once

#include <Eigen/Core>

#include "swiftlet/control/supervision/state.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

struct FlightState {
  SupervisorState supervisor;
  Eigen::Vector3d position_integral = Eigen::Vector3d::Zero();  // m/s^2, in NED
  plant::RotorState rotor_state = plant::RotorState::kOff;      // of the last command, as is throttle
  plant::PerRotor throttle{};
  GainChange gains;         // in force, or changing
  double lift_ratio = 0.0;  // of LiftObserver; 0: not lifted off
};

}  // namespace swiftlet::control

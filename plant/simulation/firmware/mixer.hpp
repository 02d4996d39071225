// Mixer of a flight-control firmware: thrust and moments to a throttle for each rotor.
#pragma once

#include <Eigen/Core>

#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

class Mixer {
 public:
  explicit Mixer(const Vehicle& vehicle);

  // Thrusts by the pseudo-inverse. If one exceeds what a rotor gives at full throttle, all are reduced by the excess,
  // as on the Crazyflie: moments come before thrust. Negative thrusts become 0. Then the throttle of each by the
  // identified curve at this supply voltage.
  PerRotor throttles(double thrust_n, const Eigen::Vector3d& moment_frd, double supply_voltage_v) const;

 private:
  Vehicle vehicle_;
  Allocation thrust_per_wrench_;
};

}  // namespace swiftlet::plant

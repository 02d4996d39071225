// Thrust over throttle, without the rotor's speed: the whole chain at once, T = k_T Omega_ss(v_a)^2 by Eq.
// (9), (22) and (25).
#pragma once

#include <vector>

#include "swiftlet/identification/bench/instruments.hpp"
#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

struct ThrottleThrustData {
  std::vector<double> supply_voltage_v;  // v_s
  std::vector<double> throttle;          // delta, 0 .. 1
  std::vector<double> thrust_n;          // of one rotor
};

// What other experiments have found, so that these data need not tell it.
struct KnownParts {
  bool esc = false;           // esc.gain, esc.offset
  bool steady_motor = false;  // motor.k2, motor.k3
  bool thrust = false;        // rotor.thrust_factor
};

// Estimates what is not known of esc.gain, esc.offset, motor.k2, motor.k3 and rotor.thrust_factor; the rest
// stays as vehicle has it. Where Eq. (9) or (22) is unknown, thrust without speed leaves a scale open: k_T
// and, if both are unknown, the gain are then held at the vehicle's too, and a warning says so. Where all is
// known, rotor.thrust_factor is estimated all the same, to compare. Intervals count what is held as exact.
// measured and predicted are T. Throws BadData.
Experiment identify_throttle_thrust(const ThrottleThrustData& data, const plant::Vehicle& vehicle,
                                    const KnownParts& known, const Instruments& instruments);

}  // namespace swiftlet::identification

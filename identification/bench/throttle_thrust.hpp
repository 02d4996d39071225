// Identifies the chain from throttle to thrust without measuring rotor speed: T = k_T Omega_ss(v_a)^2 by
// Eq. (9), (22) and (25).
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

// The parts that other experiments have identified.
struct KnownParts {
  bool esc = false;           // esc.gain, esc.offset
  bool steady_motor = false;  // motor.k2, motor.k3
  bool thrust = false;        // rotor.thrust_factor
};

// Estimates those of esc.gain, esc.offset, motor.k2, motor.k3 and rotor.thrust_factor that are not known; the
// others keep the vehicle's values. If Eq. (9) or (22) is unknown, thrust without speed does not determine
// the scale: k_T and, if both are unknown, esc.gain then also keep the vehicle's values, with a warning. If
// all are known, estimates rotor.thrust_factor for comparison. Intervals treat fixed values as exact.
// measured and predicted are T. Throws BadData.
Experiment identify_throttle_thrust(const ThrottleThrustData& data, const plant::Vehicle& vehicle,
                                    const KnownParts& known, const Instruments& instruments);

}  // namespace swiftlet::identification

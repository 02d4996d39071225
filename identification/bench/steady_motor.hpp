// Identifies the motor in steady state, Eq. (19)-(22): v_a = K2 Omega + K3 Omega^2 (the paper's Fig. 4).
#pragma once

#include <vector>

#include "swiftlet/identification/bench/instruments.hpp"
#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

struct SteadyMotorData {
  std::vector<double> motor_voltage_v;  // v_a
  std::vector<double> speed_rad_s;      // Omega
};

// Estimates motor.k2 and motor.k3. measured and predicted are v_a. Warns if an additional constant voltage is
// significant: Coulomb friction, which Eq. (15) omits. Throws BadData.
Experiment identify_steady_motor(const SteadyMotorData& data, const Instruments& instruments);

}  // namespace swiftlet::identification

// Identifies the rotor on a force and torque sensor, Eq. (25) and (26): T = k_T Omega^2, Q = k_Q Omega^2 (the
// paper's Figs. 6 and 7).
#pragma once

#include <optional>
#include <vector>

#include "swiftlet/identification/bench/instruments.hpp"
#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

struct ThrustTorqueData {
  std::vector<double> speed_rad_s;
  std::vector<double> thrust_n;    // empty: not measured
  std::vector<double> torque_n_m;  // empty: not measured
};

struct ThrustTorque {
  std::optional<Experiment> thrust;  // estimates rotor.thrust_factor; measured and predicted are T
  std::optional<Experiment> torque;  // estimates rotor.torque_factor; measured and predicted are Q
};

// Warns if an additional constant is significant: the sensor was not zeroed. Throws BadData.
ThrustTorque identify_thrust_torque(const ThrustTorqueData& data, const Instruments& instruments);

}  // namespace swiftlet::identification

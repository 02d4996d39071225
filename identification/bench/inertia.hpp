// Identifies the moment of inertia about one body axis from the period of free oscillations.
#pragma once

#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

// Bifilar pendulum: the vehicle hangs by two parallel strings of equal length, at the same distance from the
// centre of mass, and oscillates about the vertical body axis:
// J = m g separation^2 period^2 / (16 pi^2 length).
struct BifilarData {
  std::vector<double> length_m;
  std::vector<double> separation_m;
  std::vector<double> period_s;
};

// Physical pendulum: the vehicle swings about a horizontal axis that is parallel to the body axis, at
// distance arm from the centre of mass: J = m g arm period^2 / (4 pi^2) - m arm^2.
struct SwingData {
  std::vector<double> arm_m;
  std::vector<double> period_s;
};

struct InertiaTarget {
  const char* parameter = "inertia.xx";
  const char* symbol = "J_x";
  double mass_kg = 0.0;
  double mass_error = 0.0;  // relative standard error of the mass, shared by J
  double size_m = 0.0;      // m, distance of the hubs from the centre, for the plausibility check
};

// Valid for small angles. measured and predicted are periods, s. Lengths are exact; the mass has mass_error.
// Throws BadData, also if the radius of gyration is not plausible for size_m.
Experiment identify_inertia(const BifilarData& data, const InertiaTarget& target);
Experiment identify_inertia(const SwingData& data, const InertiaTarget& target);

}  // namespace swiftlet::identification

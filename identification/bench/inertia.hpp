// Moment of inertia about one body axis from the period of free swings.
#pragma once

#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

// Hung by two parallel strings of a length, separation apart, both at the same distance from the centre of
// mass, and turned about the vertical body axis: J = m g separation^2 period^2 / (16 pi^2 length).
struct BifilarData {
  std::vector<double> length_m;
  std::vector<double> separation_m;
  std::vector<double> period_s;
};

// Swung about a horizontal axis parallel to the body axis, arm away from the centre of mass:
// J = m g arm period^2 / (4 pi^2) - m arm^2.
struct SwingData {
  std::vector<double> arm_m;
  std::vector<double> period_s;
};

struct InertiaTarget {
  const char* parameter = "inertia.xx";
  const char* symbol = "J_x";
  double mass_kg = 0.0;
  double mass_error = 0.0;  // standard error of the mass, relative: J shares it
  double size_m = 0.0;      // the hubs' distance from the centre, by which results are judged
};

// Small angles. measured and predicted are periods; lengths and mass count as exact but for mass_error.
// Throws BadData.
Experiment identify_inertia(const BifilarData& data, const InertiaTarget& target);
Experiment identify_inertia(const SwingData& data, const InertiaTarget& target);

}  // namespace swiftlet::identification

// Identifies the mass from repeated weighings.
#pragma once

#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

// Estimates mass from readings in kg. Throws BadData.
Experiment identify_mass(const std::vector<double>& mass_kg);

}  // namespace swiftlet::identification

// The picture of a checked fleet.
#pragma once

#include "swiftlet/analysis/plot/figure.hpp"
#include "swiftlet/ground/fleet/fleet_check.hpp"

namespace swiftlet::ground {

// The paths of all vehicles over time, from above and in space, and the least clearance of all pairs over time, as planned.
plot::Figure fleet_figure(const FleetCheck& check);

}  // namespace swiftlet::ground

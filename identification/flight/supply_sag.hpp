// How the supply's sag bears on what commands do.
#pragma once

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Near hover, the thrust that a small change of all rotors' commands makes of each, over what as much makes
// of a rotor while others change against it: all together draw the supply down. Between 0 and 1; by Eq.
// (9), (22) and (25) with the vehicle's battery at half its charge, settled.
double shared_over_single(const plant::Vehicle& vehicle);

}  // namespace swiftlet::identification

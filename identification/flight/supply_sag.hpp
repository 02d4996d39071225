// Effect of the supply's sag on the thrust of a command.
#pragma once

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Ratio, between 0 and 1, of two changes of a rotor's thrust near hover: by a small change of the commands of
// all rotors, and by the same change of its own command while others change oppositely. Only the former makes
// the supply voltage sag. By Eq. (9), (22) and (25), in steady state, with the battery at half its charge.
double shared_over_single(const plant::Vehicle& vehicle);

}  // namespace swiftlet::identification

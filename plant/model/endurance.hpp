// How long a battery carries its vehicle.
#pragma once

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// The voltage under load, v_s of Eq. (9), of a hovering vehicle at this state of charge, 0 .. 1, in V; 0 if it cannot hover. The rotors
// share m g, Eq. (22) and (25); the ESCs have no loss (esc.hpp).
double hover_voltage(const Vehicle& vehicle, double state_of_charge);

// Seconds of hover from a state of charge on, until hover_voltage() falls below least_voltage_v or the battery is empty; 0 if it is
// below at once.
double hover_endurance_s(const Vehicle& vehicle, double state_of_charge, double least_voltage_v);

}  // namespace swiftlet::plant

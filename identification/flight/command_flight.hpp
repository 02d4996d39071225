// From logs of IMU and commands alone, without poses or supply voltage, to what they can tell: the rotors'
// lag, delays, thrust over mass by command, and how the rotors turn the body.
#pragma once

#include <vector>

#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"

namespace swiftlet::identification {

// Completes an identification that has its windows. The lag is fitted to specific force, roll and pitch each
// alone, then to all; where the three differ by more than their intervals allow, the interval of the lag is
// widened to what they leave open (Birge 1932), and with it those of all that hangs together with it. Moments
// of inertia are those that the base's mass and levers make of the gains. Throws BadData.
void identify_commands(FlightIdentification& out, const std::vector<FlightSeries>& flights,
                       const plant::Vehicle& base, const FlightOptions& options);

}  // namespace swiftlet::identification

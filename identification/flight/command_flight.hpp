// Identifies from logs of IMU and commands, without poses or supply voltage, what they determine: rotor lag,
// delays, thrust over mass as a function of the command, and the gains from thrust to angular acceleration.
#pragma once

#include <vector>

#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"

namespace swiftlet::identification {

// Completes `out`, of which windows and source are set. Fits the lag to specific force, roll and pitch alone,
// then to all responses. If the three lags differ by more than their intervals allow, widens the interval of
// the lag by Birge's ratio (Birge 1932), and those of the parameters correlated with it. Moments of inertia
// follow from the gains with the base vehicle's mass and levers. Throws BadData.
void identify_commands(FlightIdentification& out, const std::vector<FlightSeries>& flights,
                       const plant::Vehicle& base, const FlightOptions& options);

}  // namespace swiftlet::identification

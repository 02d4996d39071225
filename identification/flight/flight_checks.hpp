// Checks the readings of a flight's log before the fit: they must vary, be physically plausible in their
// units, and agree with each other. All functions throw BadData.
#pragma once

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

struct FlightSeries;

// Checks the sample period: fast enough for the motion of a small vehicle, slow enough for an IMU.
void require_times(const FlightLog& log);

// Checks that specific force, body rates, commands, rotor speeds and supply voltage of the flight vary and
// are plausible.
void require_readings(const FlightLog& log, const Rows& flight);

// Checks the rotor speeds against the steady speeds of the base vehicle's motors at the log's commands.
void require_speeds_match_motors(const FlightSeries& series, const plant::Vehicle& base);

// Checks the positions against the specific force: both must give the same change of velocity over a segment.
void require_positions_match_force(const FlightSeries& series);

}  // namespace swiftlet::identification

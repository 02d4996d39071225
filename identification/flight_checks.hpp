// What a flight's log must be before anything is believed of it: readings that vary, in units that physics
// allows, and that agree with each other. All throw BadData.
#pragma once

#include "identification/estimate.hpp"
#include "identification/flight_log.hpp"
#include "identification/flight_window.hpp"
#include "plant/model/vehicle.hpp"

namespace swiftlet::identification {

struct FlightSeries;

// What was sensed and commanded in the flight.
void demand_readings(const FlightLog& log, const Rows& flight);

// Rotor speeds against those that the base vehicle's motors settle at under the log's commands.
void demand_speeds_like_the_motors(const FlightSeries& series, const plant::Vehicle& base);

// Positions against the specific force: what the one gains of speed over a stretch, the other asks for.
void demand_positions_as_felt(const FlightSeries& series);

// A moment of inertia about roll or pitch against the rotors' lever: of no mass as far out as several levers,
// nor all of it near the centre. Not of estimates that tell nothing.
void demand_inertia_of_a_body(const Estimate& inertia, double mass_kg, double lever_m);

}  // namespace swiftlet::identification

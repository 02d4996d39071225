// What a flight's log must be before anything is believed of it: readings that vary, in units that physics
// allows, and that agree with each other. All throw BadData.
#pragma once

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/recording/flight_log.hpp"

namespace swiftlet::identification {

struct FlightSeries;

// Sampled at a rate that holds the motion of a small vehicle, and that such a vehicle's IMU has.
void require_times(const FlightLog& log);

// What was sensed and commanded in the flight.
void require_readings(const FlightLog& log, const Rows& flight);

// Rotor speeds against those that the base vehicle's motors settle at under the log's commands.
void require_speeds_like_the_motors(const FlightSeries& series, const plant::Vehicle& base);

// Positions against the specific force: what the one gains of speed over a stretch, the other asks for.
void require_positions_as_felt(const FlightSeries& series);

}  // namespace swiftlet::identification

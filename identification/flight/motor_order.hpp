// Checks that the commands of a log belong to the rotors of the vehicle in its order: by the sign and the axis of the angular
// acceleration that each motor causes.
#pragma once

#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Compares the orders of the motors by how much of the changes of the rates their moments explain. Throws BadData that names the
// motors if another order explains them clearly better. A calm flight decides nothing, and is accepted.
void require_motor_order(const FlightLog& log, const Rows& flight, const plant::Vehicle& base);

}  // namespace swiftlet::identification

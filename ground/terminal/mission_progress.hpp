// The state of a vehicle and the progress of its mission on one line.
#pragma once

#include <string>

#include "swiftlet/ground/client/vehicle.hpp"

namespace swiftlet::ground {

// "mission  ( 1.00,  0.00, -1.00) m, 3.92 V"; says so where a position or voltage is not known yet.
std::string state_text(const VehicleState& state);
// "2/6  mission  ( 1.00,  0.00, -1.00) m, 3.92 V"
std::string mission_progress_text(const VehicleState& state);

}  // namespace swiftlet::ground

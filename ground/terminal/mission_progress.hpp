// The progress of a mission on one line.
#pragma once

#include <string>

#include "swiftlet/ground/client/vehicle.hpp"

namespace swiftlet::ground {

// "2/6  mission  ( 1.00,  0.00, -1.00) m, 3.92 V"; says so where a position or voltage is not known yet.
std::string mission_progress_text(const VehicleState& state);

}  // namespace swiftlet::ground

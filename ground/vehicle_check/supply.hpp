// Checks of the battery's samples.
#pragma once

#include <optional>

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// full_battery_v: of the vehicle file; without it, the voltage must be that of some battery.
CheckResults check_supply(const VehicleRecording& recording, std::optional<double> full_battery_v);

}  // namespace swiftlet::ground

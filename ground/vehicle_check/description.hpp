// Compares vehicle_info with the vehicle file.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

CheckResults check_description(const VehicleRecording& recording, const plant::Vehicle& vehicle);

}  // namespace swiftlet::ground

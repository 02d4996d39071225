// Checks of the range of the IMU over fast motion: overflow of 16-bit values and saturation.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

CheckResults check_imu_range(const VehicleRecording& recording);

}  // namespace swiftlet::ground

// Checks of an estimate of its own that a vehicle brings in place of IMU samples, while it stands with rotors off.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// True if it publishes vehicle_odometry, and no imu.
bool brings_odometry(const VehicleRecording& recording);

CheckResults check_odometry_at_rest(const VehicleRecording& recording);

}  // namespace swiftlet::ground

// Checks of the streams: that their messages arrive, are valid, and come at their rate with stamps of the vehicle's
// clock.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// How fast the clock of a vehicle runs over that of this computer: 1 unless it is a simulation at another speed, by its
// vehicle_info and its IMU.
double vehicle_rate(const VehicleRecording& recording);

CheckResults check_imu_stream(const VehicleRecording& recording);
// The stream of a vehicle that brings vehicle_odometry in place of imu.
CheckResults check_odometry_stream(const VehicleRecording& recording);
CheckResults check_battery_stream(const VehicleRecording& recording);
// Optional for a vehicle: skipped if nobody publishes it.
CheckResults check_rotor_speed_stream(const VehicleRecording& recording);
// required: a recording without poses fails; otherwise its checks are skipped.
CheckResults check_mocap_stream(const VehicleRecording& recording, bool required);

}  // namespace swiftlet::ground

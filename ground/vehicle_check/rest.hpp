// Checks of the samples of a vehicle that stands level and still with its rotors off: size and direction of
// gravity, units, bias, noise, and values that are not measured.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

CheckResults check_imu_at_rest(const VehicleRecording& recording);
// Needs the results of check_imu_at_rest(): compares the attitude with the direction of gravity.
CheckResults check_mocap_at_rest(const VehicleRecording& recording, const CheckResults& imu);

// Mean specific force, m/s^2; zero for no samples.
Eigen::Vector3d mean_specific_force(const VehicleRecording& recording);
Eigen::Vector3d mean_body_rates(const VehicleRecording& recording);

}  // namespace swiftlet::ground

// All checks of a vehicle that stands on the floor with its rotors off. They need neither motion nor commands.
#pragma once

#include <Eigen/Core>

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

// vehicle: null if its file is not known. mocap_required: a recording without poses fails. A recording of a vehicle in
// lockstep fails with that finding alone.
CheckResults check_standing_vehicle(const VehicleRecording& recording, const plant::Vehicle* vehicle,
                                    bool mocap_required);

// Mean specific force, m/s^2; zero for no samples.
Eigen::Vector3d mean_specific_force(const VehicleRecording& recording);
Eigen::Vector3d mean_body_rates(const VehicleRecording& recording);

}  // namespace swiftlet::ground

// Checks of order and spin of the rotors by raising the throttle of one at a time.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/command_phases.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// Without propellers: by rotor_speeds, and by what a person has seen.
CheckResults check_rotor_spins(const VehicleRecording& recording, const CommandPhases& phases,
                               const plant::Vehicle& vehicle);

// With propellers, free to turn on a tether: by the turn of the vehicle, which shows where the thrust is and the
// reaction torque. kIdle is a common throttle here.
CheckResults check_rotor_thrusts(const VehicleRecording& recording, const CommandPhases& phases,
                                 const plant::Vehicle& vehicle);

std::string place_of(const plant::RotorMount& mount);  // "front right"

}  // namespace swiftlet::ground

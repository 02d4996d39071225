// Checks of what the vehicle makes of actuator commands: it obeys them, refuses lower terms, stops its rotors on
// command and when commands cease.
#pragma once

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/command_phases.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// A phase that is missing fails.
CheckResults check_commands(const VehicleRecording& recording, const CommandPhases& phases);

}  // namespace swiftlet::ground

// Whether the rotors turn, as far as the vehicle tells: by rotor_speeds, else by vehicle_info.
#pragma once

#include <cstdint>
#include <optional>

#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"

namespace swiftlet::ground {

// Mean speeds, rad/s, of the samples received in this time; nullopt without any.
std::optional<plant::PerRotor> mean_rotor_speeds(const VehicleRecording& recording, std::int64_t begin_ns,
                                                 std::int64_t end_ns);

// At the end of this time; nullopt if the vehicle publishes neither.
std::optional<bool> rotors_turn(const VehicleRecording& recording, std::int64_t begin_ns,
                                std::int64_t end_ns);

// The first time in begin_ns .. end_ns at which the rotors were seen to slow down or to be off. speeds_before: while they
// ran, empty if not measured.
std::optional<std::int64_t> rotors_slow_at(const VehicleRecording& recording, std::int64_t begin_ns,
                                           std::int64_t end_ns,
                                           const std::optional<plant::PerRotor>& speeds_before);

}  // namespace swiftlet::ground

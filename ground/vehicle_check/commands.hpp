// Checks of what the vehicle makes of actuator commands: it obeys them, refuses lower terms, stops its rotors on
// command and when commands cease, and raises the rotor that was asked for.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/vehicle_check/check_result.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {

enum class CommandStage {
  kOff,        // rotors off
  kIdle,       // rotors running, throttle 0 or a common throttle
  kSpin,       // as kIdle, with a higher throttle of one rotor
  kLowerTerm,  // rotors off, with a lower term than the commands before
  kSilence,    // no commands, after kIdle
  kStopped,    // rotors off, after kIdle
};

// What was commanded, and when.
struct CommandPhase {
  CommandStage stage = CommandStage::kOff;
  std::uint32_t term = 0;
  std::int64_t begin_ns = 0;  // computer's clock
  std::int64_t end_ns = 0;
  int rotor = 0;  // kSpin: from 1, as in the vehicle file
  // kSpin: what a person has seen.
  std::optional<int> seen_rotor{};
  std::optional<plant::Spin> seen_spin{};
};
using CommandPhases = std::vector<CommandPhase>;  // in order

const CommandPhase* phase_of(const CommandPhases& phases, CommandStage stage);  // the first; null: none

// A phase that is missing fails.
CheckResults check_commands(const VehicleRecording& recording, const CommandPhases& phases);

// Order and spin of the rotors without propellers: by rotor_speeds, and by what a person has seen.
CheckResults check_rotor_spins(const VehicleRecording& recording, const CommandPhases& phases,
                               const plant::Vehicle& vehicle);

// With propellers, free to turn on a tether: by the turn of the vehicle, which shows where the thrust is and the
// reaction torque. kIdle is a common throttle here.
CheckResults check_rotor_thrusts(const VehicleRecording& recording, const CommandPhases& phases,
                                 const plant::Vehicle& vehicle);

std::string place_of(const plant::RotorMount& mount);  // "front right"

}  // namespace swiftlet::ground

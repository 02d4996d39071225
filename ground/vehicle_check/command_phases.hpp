// What was commanded during the checks of commands and rotors, in order.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

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
using CommandPhases = std::vector<CommandPhase>;

const CommandPhase* phase_of(const CommandPhases& phases, CommandStage stage);  // the first; null: none

}  // namespace swiftlet::ground

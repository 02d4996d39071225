// Recordings of a vehicle as it should be, made by the models of the simulation: standing, in a hand, and commanded.
#pragma once

#include <functional>
#include <vector>

#include "swiftlet/ground/vehicle_check/commands.hpp"
#include "swiftlet/ground/vehicle_check/hand_motion.hpp"
#include "swiftlet/ground/vehicle_check/vehicle_recording.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::tests {

plant::Vehicle kaylion();

// At rest for 2 s.
ground::VehicleRecording record_standing();

struct RecordedHand {
  ground::VehicleRecording rest;
  ground::VehicleRecording motion;
  std::vector<ground::HandSegment> segments;
};
RecordedHand record_hand();

// A vehicle that does not do what it should with commands.
struct CommandDefects {
  bool ignores_timeout = false;
  bool obeys_lower_terms = false;
  bool turns_while_off = false;
  bool reports_nothing = false;           // UNREPORTED
  bool is_deaf = false;                   // obeys nothing
  bool idles_off = false;                 // rotors stand at throttle 0
  std::vector<int> rotor_of{1, 2, 3, 4};  // that each command reaches
};

struct RecordedCommands {
  ground::VehicleRecording recording;
  ground::CommandPhases phases;
};
// Without propellers: the rotors do not move the vehicle. All steps of `swiftlet check vehicle --props-off`.
RecordedCommands record_commands(const CommandDefects& defects);

// With propellers, free in the air: all steps of `swiftlet check vehicle --tethered`. built: as the vehicle is;
// commands reach rotor_of.
RecordedCommands record_thrusts(const plant::Vehicle& built, const std::vector<int>& rotor_of);

}  // namespace swiftlet::tests

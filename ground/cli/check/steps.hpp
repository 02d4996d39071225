// The steps of `swiftlet check vehicle` that command the vehicle or ask a person to move it.
#pragma once

#include <vector>

#include "swiftlet/ground/cli/check/operator_dialog.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/vehicle_check/commands.hpp"
#include "swiftlet/ground/vehicle_check/hand_motion.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// Both send rotors off at their end, also when they throw: Interrupted, or std::runtime_error if a controller is alive
// or appears, or IMU samples cease.

// Without propellers: rotors off, idle, each rotor by itself, a lower term, silence. At a terminal asks which rotor
// turns, and in which direction.
CommandPhases command_without_propellers(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                         const plant::Vehicle& vehicle, const OperatorDialog& dialog);

// Tethered, with propellers: half the thrust of hover, and each rotor raised for a moment.
CommandPhases command_on_tether(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                const plant::Vehicle& vehicle, const OperatorDialog& dialog);

// `--hand`: asks for each motion and records it. Steps that motion capture does not see within their time are not among
// the segments, and end the sequence. Throws Interrupted.
std::vector<HandSegment> guide_hand(const SampleRecorder& recorder, const OperatorDialog& dialog);

}  // namespace swiftlet::ground

// The steps of `swiftlet check vehicle` that command the vehicle. It must not be flown by anybody meanwhile.
#pragma once

#include "swiftlet/ground/cli/check/operator_dialog.hpp"
#include "swiftlet/ground/cli/check/sample_recorder.hpp"
#include "swiftlet/ground/vehicle_check/commands.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/dds/node.hpp"

namespace swiftlet::ground {

// All send rotors off at their end, also when they throw: Interrupted, or std::runtime_error if a controller is alive
// or appears, or IMU samples cease.

// Without propellers: rotors off, idle, each rotor by itself, a lower term, silence. At a terminal asks which rotor
// turns, and in which direction.
CommandPhases command_without_propellers(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                         const plant::Vehicle& vehicle, const OperatorDialog& dialog);

// Tethered, with propellers: half the thrust of hover, and each rotor raised for a moment.
CommandPhases command_on_tether(const SampleRecorder& recorder, const dds::NodeSettings& network,
                                const plant::Vehicle& vehicle, const OperatorDialog& dialog);

// Throws std::runtime_error if somebody commands the vehicle.
void require_no_controller(const SampleRecorder& recorder);

}  // namespace swiftlet::ground

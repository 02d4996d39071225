// The options that the commands which fly a mission have in common.
#pragma once

#include <optional>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// In all functions `options` must outlive the parsing.

// Adds mission, the options of add_file_options(), --vehicle, --control, --simulation, --seed and --imu-rate.
void add_mission_options(runtime::CommandLine app, FlyOptions& options);
// Adds the options of add_mission_options(), --level, --record, --replace and --json.
void add_fly_options(runtime::CommandLine app, FlyOptions& options);
// Adds --record, --replace and --json.
void add_record_options(runtime::CommandLine app, FlyOptions& options);
// Adds --attach, --skip-check, --skip-hover-test, --clock, --speed, --view and --trace, and changes the network options of `app`. Returns
// --attach.
runtime::Option add_launch_options(runtime::CommandLine app, FlyOptions& options);
// Adds --level: at which the vehicle is commanded.
// Of the radio between vehicle and control.
void add_radio_options(runtime::CommandLine app, FlyOptions& options);
void add_level_option(runtime::CommandLine app, plant::ControlLevel& level);
// Adds --frame, --tolerance, --columns, --scale ... --as-fast-as-possible: how a file is read, where and how fast it is flown.
void add_file_options(runtime::CommandLine app, ReadingOptions& options);
// Adds --frame: the frame of a file that does not name its own.
void add_frame_option(runtime::CommandLine app, std::optional<io::MissionFrame>& frame);
// Adds --dispersion.
runtime::Option add_dispersion_option(runtime::CommandLine app, FlyOptions& options);

}  // namespace swiftlet::ground

// What the subcommands of `swiftlet mocap` share.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/mocap/sources/source_options.hpp"
#include "swiftlet/services/runtime/stop_signal.hpp"

namespace swiftlet::ground {

// Throws InputError or ConfigError for bad input.
std::unique_ptr<mocap::Source> open_mocap_source(const mocap::SourceOptions& options,
                                                 const std::vector<std::string>& vehicles);

// Whether a signal asked to end; does not wait.
bool is_interrupted(runtime::StopSignal& stop);

io::Command add_mocap_calibrate_command(runtime::CommandLine mocap);

}  // namespace swiftlet::ground

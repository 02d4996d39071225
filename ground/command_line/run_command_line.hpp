// The frame of the ground tool's programs: reads the command line, runs, and says what went wrong.
#pragma once

#include <functional>

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::ground {

// The exit code of the program: that of `run`, kDone after --help, kBadInput after wrong usage, an InputError or a
// runtime::ConfigError, kFailed after any other exception. A fault is one line on stderr.
int run_command_line(runtime::Program& program, int argc, char** argv, const std::function<int()>& run);

}  // namespace swiftlet::ground

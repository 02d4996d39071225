// The main function of the ground tool's programs: parses the command line, runs and reports errors.
#pragma once

#include <functional>

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::io {

// Returns the exit code of `run`: kBadInput after an InputError or a io::ConfigError, kFailed after any other exception. Prints an
// error as one line to standard error.
int run_reporting_errors(const std::function<int()>& run);

// Returns the exit code of the program: that of `run`, kDone after --help, kBadInput after wrong usage, an
// InputError or a io::ConfigError, kFailed after any other exception or if standard output cannot be
// written. Prints an error as one line to standard error.
int run_command_line(runtime::Program& program, int argc, char** argv, const std::function<int()>& run);

}  // namespace swiftlet::io

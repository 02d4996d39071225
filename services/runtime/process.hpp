// Common parts of the services' main functions: options and exit codes.
#pragma once

#include <functional>

#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/services/runtime/command_line.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/realtime.hpp"

namespace swiftlet::runtime {

struct ProcessOptions {
  LogSettings log;
  RealtimeSettings realtime;
};

void add_log_options(CommandLine app, LogSettings& log);  // --log-level, --log-file

// Adds the options of add_log_options(), --no-realtime, --priority, --cpu. The priority in options is the default.
void add_process_options(CommandLine app, ProcessOptions& options);

// Locks memory and checks that make_this_thread_realtime() will succeed. Logs one warning with what the
// system refuses. Does neither if disabled or in lockstep, which has no real-time requirements.
// Returns the settings that apply under this clock: disabled in lockstep.
RealtimeSettings prepare_realtime(RealtimeSettings settings, Clock clock);

// The texts of --help besides the options.
struct ProgramText {
  const char* name;
  const char* purpose;
  const char* example;            // arguments
  const char* version = nullptr;  // with it, the program has --version
};

// The last step of a main function: writes out standard output. Returns `exit_code`, or 1 instead of 0 after
// one line on stderr if some of the output could not be written.
int exit_code_after_output(const char* program, int exit_code);

// Parses the command line, which also has --version, limits the stacks of threads, then runs body. Exit code:
// 0 done (also --help); 2 wrong usage or bad input (ConfigError, std::invalid_argument); 1 any other
// exception, or standard output that cannot be written. Prints an error as one line on stderr.
int run_process(const ProgramText& text, int argc, char** argv,
                const std::function<void(CommandLine)>& add_options, const std::function<void()>& body);

}  // namespace swiftlet::runtime

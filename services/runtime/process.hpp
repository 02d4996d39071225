// What the services' mains have in common: options and exit codes.
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

// --log-level, --log-file, --no-realtime, --priority, --cpu. The priority in options is the default.
void add_process_options(CommandLine app, ProcessOptions& options);

// Locks memory and tries what make_this_thread_realtime() will do. What the system refuses is one line of
// warning.
//
// Returns the settings that hold under this clock: in lockstep nothing is in a hurry, and nothing is asked of
// the system.
RealtimeSettings prepare_realtime(RealtimeSettings settings, Clock clock);

// What --help says besides the options.
struct ProgramText {
  const char* name;
  const char* purpose;
  const char* example;  // arguments
};

// Reads the command line, limits the stacks of threads, then runs body. Exit code: 0 done (also --help); 2
// wrong usage or bad input (ConfigError, std::invalid_argument); 1 any other exception. A fault is one line
// on stderr.
int run_process(const ProgramText& text, int argc, char** argv,
                const std::function<void(CommandLine)>& add_options, const std::function<void()>& body);

}  // namespace swiftlet::runtime

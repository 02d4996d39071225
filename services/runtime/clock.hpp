// The source of simulated time.
#pragma once

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::runtime {

enum class Clock {
  kRealtime,  // the computer's clock, times a speed factor
  kLockstep,  // simulated time waits until the samples of each stamp have been answered
};

// --clock realtime|lockstep. `clock` must outlive the parsing.
void add_clock_option(CommandLine app, Clock& clock);

const char* to_string(Clock clock);  // as on the command line

}  // namespace swiftlet::runtime

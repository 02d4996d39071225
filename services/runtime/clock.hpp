// What makes simulated time pass.
#pragma once

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::runtime {

enum class Clock {
  kRealtime,  // the computer's clock, scaled
  kLockstep,  // the answers: time stands still until the samples of this moment have been answered
};

// --clock realtime|lockstep. `clock` must outlive the parsing.
void add_clock_option(CommandLine app, Clock& clock);

const char* to_string(Clock clock);  // as on the command line

}  // namespace swiftlet::runtime

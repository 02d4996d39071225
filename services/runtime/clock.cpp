#include "swiftlet/services/runtime/clock.hpp"

namespace swiftlet::runtime {

void add_clock_option(CommandLine app, Clock& clock) {
  app.add_choice("--clock", clock, {{"realtime", Clock::kRealtime}, {"lockstep", Clock::kLockstep}},
                 "realtime, or lockstep: simulated time waits for the answers to its samples")
      .show_default("realtime");
}

const char* to_string(Clock clock) { return clock == Clock::kRealtime ? "realtime" : "lockstep"; }

}  // namespace swiftlet::runtime

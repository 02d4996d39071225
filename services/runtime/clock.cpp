#include "services/runtime/clock.hpp"

#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace swiftlet::runtime {

void add_clock_option(CLI::App& app, Clock& clock) {
  static const std::map<std::string, Clock> kClocks{{"realtime", Clock::kRealtime},
                                                    {"lockstep", Clock::kLockstep}};
  app.add_option("--clock", clock,
                 "realtime, or lockstep: simulated time waits for the answers to its samples")
      ->transform(CLI::CheckedTransformer(kClocks).description("{realtime,lockstep}"))
      ->default_str("realtime");
}

const char* to_string(Clock clock) { return clock == Clock::kRealtime ? "realtime" : "lockstep"; }

}  // namespace swiftlet::runtime

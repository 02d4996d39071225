// The actions of `swiftlet identify`. Each reads its input, fits, prints and writes the results, and returns
// the exit code. They throw the same exceptions as a Command.
#pragma once

#include <chrono>

#include "swiftlet/analysis/identify/identify_options.hpp"

namespace swiftlet::analysis {

constexpr std::chrono::milliseconds kProgressAfter{500};  // shorter runs show no progress

int identify_bench(const IdentifyBenchOptions& options);
int identify_flight(IdentifyFlightOptions options);
int identify_simulate(const IdentifySimulateOptions& options);

}  // namespace swiftlet::analysis

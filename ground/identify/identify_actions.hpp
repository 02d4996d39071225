// The actions of `swiftlet identify`. Each reads its input, fits, prints and writes the results, and returns
// the exit code. They throw the same exceptions as a Command.
#pragma once

#include "swiftlet/ground/identify/identify_options.hpp"

namespace swiftlet::ground {

int identify_bench(const IdentifyBenchOptions& options);
int identify_flight(IdentifyFlightOptions options);
int identify_simulate(const IdentifySimulateOptions& options);

}  // namespace swiftlet::ground

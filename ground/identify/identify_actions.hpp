// What `swiftlet identify` does: reads, fits, prints, writes. Each returns the exit code, or throws as a
// Command does.
#pragma once

#include "swiftlet/ground/identify/identify_options.hpp"

namespace swiftlet::ground {

int identify_bench(const IdentifyBenchOptions& options);
int identify_flight(IdentifyFlightOptions options);
int identify_simulate(const IdentifySimulateOptions& options);

}  // namespace swiftlet::ground

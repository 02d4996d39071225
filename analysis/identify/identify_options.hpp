// The command line of `swiftlet identify`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "swiftlet/analysis/logs/flight_log_files.hpp"
#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::analysis {

// Options of `swiftlet identify BENCH_DIR`.
struct IdentifyBenchOptions {
  std::string bench;
  std::string out;
  std::string report;
  std::string base;
  std::string name;
  bool json = false;
};

// Options of `swiftlet identify flight`.
struct IdentifyFlightOptions {
  std::vector<std::string> logs;
  std::string vehicle;  // of recorded messages of several vehicles
  std::string base;
  std::string out;
  std::string report;
  std::string name;
  identification::FlightOptions fit;
  BodyAxes axes = BodyAxes::kDetected;
  bool json = false;
};

// Options of `swiftlet identify simulate`.
struct IdentifySimulateOptions {
  std::string vehicle = "kaylion";
  std::string out;
  identification::BenchNoise noise;
  std::uint64_t seed = 1;
};

// `swiftlet identify` with its options.
io::Command add_identify_command(runtime::CommandLine root);

}  // namespace swiftlet::analysis

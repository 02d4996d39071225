// The command line of `swiftlet identify`. `swiftlet` uses it for help and completion; `swiftlet-identify`
// runs the actions and is the only program that links the fitting libraries.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "swiftlet/ground/command_line/command.hpp"
#include "swiftlet/identification/bench/bench_simulation.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/io/logs/flight_log_files.hpp"

namespace swiftlet::ground {

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

// The actions of the three forms of the command. Each returns the exit code.
struct IdentifyActions {
  std::function<int(const IdentifyBenchOptions&)> bench;
  std::function<int(const IdentifyFlightOptions&)> flight;
  std::function<int(const IdentifySimulateOptions&)> simulate;
};

constexpr const char* kIdentifyPurpose = "Identify a vehicle from test bench data, or from flights";

// Adds options and subcommands to the command.
Command add_identify_options(runtime::CommandLine identify, const IdentifyActions& actions);

}  // namespace swiftlet::ground

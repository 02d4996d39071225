// The command line of `swiftlet identify`. It belongs to `swiftlet`, which explains and completes it, and to
// `swiftlet-identify`, which does what it says: that program alone links what the fits need.
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

// From test bench data.
struct IdentifyBenchOptions {
  std::string bench;
  std::string out;
  std::string report;
  std::string base;
  std::string name;
  bool json = false;
};

// From logs of flights.
struct IdentifyFlightOptions {
  std::vector<std::string> logs;
  std::string base;
  std::string out;
  std::string report;
  std::string name;
  identification::FlightOptions fit;
  BodyAxes axes = BodyAxes::kAsSaid;
  bool json = false;
};

// Bench data of a known vehicle.
struct IdentifySimulateOptions {
  std::string vehicle = "kaylion";
  std::string out;
  identification::BenchNoise noise;
  std::uint64_t seed = 1;
};

// What the command does in its three forms; each returns the exit code.
struct IdentifyActions {
  std::function<int(const IdentifyBenchOptions&)> bench;
  std::function<int(const IdentifyFlightOptions&)> flight;
  std::function<int(const IdentifySimulateOptions&)> simulate;
};

constexpr const char* kIdentifyPurpose = "Identify a vehicle from test bench data, or from flights";

// Adds the options and the subcommands to the command itself.
Command add_identify_options(runtime::CommandLine identify, const IdentifyActions& actions);

}  // namespace swiftlet::ground

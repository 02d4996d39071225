// `swiftlet gains`: the control design that results from a vehicle file and control settings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/plant/model/control_level.hpp"

namespace swiftlet::ground {

struct GainsOptions {
  std::string vehicle = "kaylion";           // a file, or the name of one in config/vehicles
  std::string control = "motor_lag";         // a file, or the name of one in config/control
  std::size_t samples = 1000;                // sampled vehicles, if the vehicle file states an uncertainty
  std::uint64_t seed = 1;                    // of the first sample
  std::optional<plant::ControlLevel> level;  // of a vehicle that closes loops itself
  double delay_s = 0.0;                      // at that level, from a sample to the vehicle
  bool json = false;
};

// Prints the JSON or the table, and names unstable loops on standard error. Returns kDone. Throws
// io::ConfigError for an invalid file.
int run_gains(const GainsOptions& options);

}  // namespace swiftlet::ground

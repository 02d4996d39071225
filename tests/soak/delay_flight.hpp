// A flight over three hosts, of which the controller is behind a slow network. Needs root.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/soak/network_flight.hpp"

namespace swiftlet::soak {

struct DelaySettings {
  int delay_ms = 20;   // each way, between control and all others
  int jitter_ms = 4;   // added or taken away, at most: frames overtake each other
  int duplicated = 0;  // % of the frames that arrive twice
  std::uint64_t seed = 1;
  std::string mission = "square";  // file, or name in config/missions

  double round_trip_s() const { return 2e-3 * (delay_ms + jitter_ms); }
};

// What `swiftlet status` shows of the loop's delay.
struct ShownDelay {
  double p50_s = -1.0;
  double p95_s = -1.0;
  double margin_s = -1.0;
  bool near_margin = false;
};

struct DelayResult {
  ShownDelay before;  // with the default gains, on the ground
  ShownDelay after;   // with gains of `swiftlet tune delay` for the round trip, after the flight
  NetworkFlight::Result flight;
  std::uint64_t overtaken = 0;   // frames
  std::uint64_t duplicated = 0;  // frames

  bool good() const {
    return flight.completed && flight.fault.empty() && flight.rms_m < kLargestRms_m && !after.near_margin;
  }
  static constexpr double kLargestRms_m = 0.1;  // the tolerance of the missions
};

// Starts with the default gains, changes to those for the delay with `swiftlet set control`, and flies. Programs write
// their output into the folder. Throws std::runtime_error if the hosts cannot be made.
DelayResult fly_with_delay(const DelaySettings& settings, const std::filesystem::path& folder);

}  // namespace swiftlet::soak

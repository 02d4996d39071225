// A flight in which the network between two hosts is cut for a time. Needs root.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tests/soak/network_flight.hpp"

namespace swiftlet::soak {

enum class Outcome {
  kFliesOn,  // the mission goes on
  kHolds,    // the mission is aborted, and it hovers
  kLands,    // with a failsafe
  kFalls,    // the rotors stop in flight
};
const char* to_string(Outcome outcome);

// A row of the table in docs/lossy-networks.md.
struct Partition {
  NetworkFlight::Host from;
  NetworkFlight::Host to;
  int cut_ms;
  bool standby;  // on the host of the vehicle
  Outcome expected;

  std::string name() const;  // "vehicle - control, 300 ms, with standby"
};
const std::vector<Partition>& partitions();

struct PartitionResult {
  std::optional<Outcome> outcome;  // nullopt: neither flew on nor came down
  std::string reason;              // of the last mode
  double deviation_m = 0.0;        // largest distance from the reference, as long as it flies the mission
  bool standby_took_over = false;
  bool healed = false;         // after the cut, all processes hear each other again
  bool had_priority = false;   // the flight threads of the controller that flies, before the cut
  bool priority_kept = false;  // they have the same scheduling as before
};

// Starts all processes on hosts of their own, flies laps, and cuts the network in flight. Programs write their output into
// the folder. Throws std::runtime_error if it cannot be started.
PartitionResult fly_through(const Partition& partition, const std::filesystem::path& folder);

}  // namespace swiftlet::soak

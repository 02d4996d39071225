// A flight in which the network between two hosts is cut for a time, several times. Needs root.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tests/soak/network_flight.hpp"
#include "tests/support/flight_samples.hpp"

namespace swiftlet::soak {

enum class Outcome {
  kFliesOn,  // the mission goes on to its next item
  kHolds,    // the mission is aborted, and it hovers
  kLands,    // with a failsafe, and disarms
  kFalls,    // the rotors stop in flight
};
const char* to_string(Outcome outcome);

// A cell of the table in docs/lossy-networks.md: a cut, and what has to come of it.
struct Cut {
  int ms;
  Outcome outcome;
  const char* reasons;  // part of CutResult::reasons
  // At most, m: while the mission is flown, of the true position from the reference of the same time; otherwise
  // horizontally, from the place of the cut to the last one.
  double within_m;
};

// A row of that table.
struct Partition {
  NetworkFlight::Host from;
  NetworkFlight::Host to;
  bool standby;     // on the host of the vehicle
  bool takes_over;  // the standby has to, at each cut; otherwise it may only where commands were missing
  // Without a newer command, at most, unless it falls. Where the standby takes over: and as long as a core stood still more.
  double longest_gap_ms;
  std::vector<Cut> cuts;

  std::string name() const;  // "vehicle - control, with standby"
};
const std::vector<Partition>& partitions();

struct CutResult {
  std::optional<Outcome> outcome;  // nullopt: neither flew on nor came down
  std::string reasons;             // of the modes entered since the cut, such as "ground link lost, landed"
  tests::FlightMetrics metrics;    // from the cut until the outcome was clear
  bool standby_took_over = false;
  // The longest time in which a core served no thread of the vehicle's priority, since before the cut.
  double core_stood_still_ms = 0.0;
  bool healed = false;         // after the cut, all processes hear each other again
  bool had_priority = false;   // the flight threads of the controller that flies, before the cut
  bool priority_kept = false;  // they have the same scheduling as before
  std::string log;             // of all programs so far
};

// What is not as it has to be, a sentence; empty: all is.
std::string fault_of(const Partition& partition, const Cut& cut, const CutResult& result);

// Starts all processes on hosts of their own, flies laps, and makes the cuts of these rows one after the other; takes off
// again after a landing. The standby starts before the first row that has one, and is there in those after it. Programs write
// their output into the folder. Throws std::runtime_error if it cannot be flown.
void fly_through(const std::vector<Partition>& rows, const std::filesystem::path& folder,
                 const std::function<void(const Partition&, const Cut&, const CutResult&)>& report);

}  // namespace swiftlet::soak

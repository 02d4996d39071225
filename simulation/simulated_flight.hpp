// A mission flown by a loop in this process, by the schedule of mission_runner.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/recording/flight_trace.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground {

struct SimulatedFlight {
  bool completed = false;
  std::string reason;        // why not; empty if completed
  double simulated_s = 0.0;  // from stamp 0
};

// What else a flight does, step by step; any of it may be empty.
struct FlightObserver {
  FlightRecord* record = nullptr;  // truth of each IMU sample, the rest at the rate of telemetry
  runtime::FlightTrace* trace = nullptr;
  std::function<bool()> cancelled;  // asked at the rate of telemetry
};

// Arms, flies and lands a fresh loop. The mission has an id other than 0, begins with a take-off, ends with a
// landing and has passed control::check(). planned_duration_s bounds the time it may take.
SimulatedFlight fly(ClosedLoop& loop, const control::Mission& mission, double planned_duration_s,
                    const FlightObserver& observer);

}  // namespace swiftlet::ground

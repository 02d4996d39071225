// Flies a mission in a single process, with the schedule of mission_runner.hpp.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/request.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/flight_trace.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::simulation {

struct SimulatedFlight {
  bool completed = false;
  std::string reason;        // why the mission was not completed; empty if it was
  double simulated_s = 0.0;  // simulated time from stamp 0
};

// Outputs of a flight during its steps, and its cancellation. Every member may be null.
struct FlightObserver {
  record::Flight* record = nullptr;  // ground truth at each IMU sample, the rest at the telemetry rate
  record::FlightTrace* trace = nullptr;
  std::function<bool()> cancelled = {};  // polled at the telemetry rate; true ends the flight
  std::function<void()> stepped = {};    // after each step of the loop
  std::function<void(const control::Request&, const control::Outcome&)> requested = {};  // after each request
};

// Arms, flies the mission and lands. The loop must be newly constructed. The mission must have an id other
// than 0, begin with a take-off, end with a landing and pass control::check(). planned_duration_s determines
// the time limit.
SimulatedFlight fly(ClosedLoop& loop, const control::Mission& mission, double planned_duration_s,
                    const FlightObserver& observer);

}  // namespace swiftlet::simulation

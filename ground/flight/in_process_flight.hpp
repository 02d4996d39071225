// Flies a planned flight in this process and judges it.
#pragma once

#include <cstdint>
#include <functional>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/flight_trace.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground {

class SimulatedRecorder;

// The closed loop of the vehicle in `world` and a controller designed for the plan's vehicle. Throws as
// ClosedLoop does.
simulation::ClosedLoop closed_loop(const LaunchConfiguration& plan, const simulation::World& world,
                                   std::uint64_t seed);

// Flies the plan's mission. loop: new, of the same seed. flight: empty; takes what is flown. trace and messages may be null.
analysis::FlightReport fly_in_process(simulation::ClosedLoop& loop, const LaunchConfiguration& plan,
                                      std::uint64_t seed, record::Flight& flight, record::FlightTrace* trace,
                                      const std::function<bool()>& cancelled,
                                      SimulatedRecorder* messages = nullptr);

}  // namespace swiftlet::ground

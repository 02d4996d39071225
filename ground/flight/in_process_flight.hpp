// Flies a planned flight in this process and evaluates it.
#pragma once

#include <cstdint>
#include <functional>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/recording/flight_trace.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground {

class SimulatedRecorder;

struct InProcessFlight {
  FlightReport report;
  Window window;  // in which the errors are evaluated
};

// The closed loop of the vehicle in `world` and a controller designed for the plan's vehicle. Throws as
// ClosedLoop does.
ClosedLoop closed_loop(const LaunchConfiguration& plan, const World& world, std::uint64_t seed);

// Flies the plan's mission. loop: new, of the same seed. record: empty, of plan.record_capacity(). trace: may
// and messages may be null.
InProcessFlight fly_in_process(ClosedLoop& loop, const LaunchConfiguration& plan, std::uint64_t seed,
                               FlightRecord& record, runtime::FlightTrace* trace,
                               const std::function<bool()>& cancelled, SimulatedRecorder* messages = nullptr);

}  // namespace swiftlet::ground

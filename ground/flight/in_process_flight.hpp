// A planned flight in this process, flown and judged.
#pragma once

#include <cstdint>
#include <functional>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "swiftlet/recording/flight_trace.hpp"
#include "swiftlet/simulation/closed_loop.hpp"

namespace swiftlet::ground {

struct InProcessFlight {
  FlightReport report;
  Window window;  // that the errors are taken from
};

// What flies in `world`, under a controller that is designed on the plan's vehicle. Throws as ClosedLoop
// does.
ClosedLoop closed_loop(const LaunchConfiguration& plan, const World& world, std::uint64_t seed);

// The plan's mission by a fresh loop of this seed. The record is an empty one of plan.record_capacity();
// trace may be null.
InProcessFlight fly_in_process(ClosedLoop& loop, const LaunchConfiguration& plan, std::uint64_t seed,
                               FlightRecord& record, runtime::FlightTrace* trace,
                               const std::function<bool()>& cancelled);

}  // namespace swiftlet::ground

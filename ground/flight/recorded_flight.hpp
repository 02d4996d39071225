// Flies a planned flight in this process, and writes its record.
#pragma once

#include <functional>

#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/ground/terminal/progress.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// Draws the vehicle and the simulation of the plan's seed, flies, and writes into the plan's folder what the plan asks
// for. The report's record_dir is that folder, and record_fault says what could not be written. options: those from
// which the plan was made. record: empty, of plan.record_capacity(). Throws InputError as RecordFolder does, and as
// ClosedLoop and draw() do.
FlightReport fly_and_record(LaunchConfiguration plan, const FlyOptions& options, FlightRecord& record,
                            const std::function<bool()>& cancelled, Progress& progress);

}  // namespace swiftlet::ground

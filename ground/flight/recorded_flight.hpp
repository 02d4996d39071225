// Flies a planned flight in this process, and writes its record.
#pragma once

#include <functional>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/io/command_line/progress.hpp"
#include "swiftlet/record/flight.hpp"

namespace swiftlet::ground {

// Draws the vehicle and the simulation of the plan's seed, flies, and writes the record into the plan's folder. The report's record_dir
// is that folder, and record_fault says what could not be written. options: those from which the plan was made. flight: empty;
// takes what is flown. Throws InputError as RecordFolder does, and as ClosedLoop and draw() do.
analysis::FlightReport fly_and_record(LaunchConfiguration plan, const FlyOptions& options,
                                      record::Flight& flight, const std::function<bool()>& cancelled,
                                      io::Progress& progress);

}  // namespace swiftlet::ground

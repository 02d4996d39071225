// The faults that a simulation injected into a flight.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/record/file/process_log.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::record {

// In the order of their starts.
std::vector<FaultRow> fault_rows(const plant::SimulationSettings& settings);

// Those in the simulation file that is attached to the recording of a flight; none if there is no such file, or one of another version.
std::vector<FaultRow> recorded_faults(const mcap::Reader& file, const std::string& vehicle);

// As a line of the log, at its start.
ProcessLogLine log_line(const FaultRow& fault);

}  // namespace swiftlet::record

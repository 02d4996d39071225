// A flight of one vehicle, read from an MCAP file of recorded messages.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/io/mcap/reader.hpp"
#include "swiftlet/recording/flight_record.hpp"

namespace swiftlet::ground {

// True if the file begins as an MCAP file does.
bool is_mcap(const std::filesystem::path& file);

// The vehicles of which the file has messages, sorted.
std::vector<std::string> recorded_vehicles(const mcap::Reader& file);

// The named vehicle; with an empty name the only one. Throws ConfigError if the file has not this one, or several.
std::string recorded_vehicle(const mcap::Reader& file, const std::string& name);

// Tracks of ground truth, reference, estimate and mission status, and of the sensors and commands. A topic that was not
// recorded leaves its track empty. As the live record, leaves out repeated samples (of a stamp that does not rise) and
// rows with numbers that are not finite. Throws ConfigError if a message does not fit its schema.
std::unique_ptr<FlightRecord> read_flight_record(const mcap::Reader& file, const std::string& vehicle);

}  // namespace swiftlet::ground

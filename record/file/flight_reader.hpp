// Reads a flight from an MCAP file of recorded messages, in one pass.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/record/flight.hpp"
#include "swiftlet/record/mcap/reader.hpp"

namespace swiftlet::record {

// The file in the folder of a flight's record.
inline constexpr const char* kFlightFile = "flight.mcap";

struct FlightFile {
  std::filesystem::path file;
  std::string vehicle;  // whose folder was given; empty: all of the file
};
// The MCAP file of a record: the file itself, or the flight.mcap in its folder, or of the folder of one of several vehicles the one
// beside it. Throws ConfigError if there is none.
FlightFile flight_file(const std::filesystem::path& record);

// True if the file begins as an MCAP file does.
bool is_mcap(const std::filesystem::path& file);

// The vehicles of which the file has messages, sorted.
std::vector<std::string> recorded_vehicles(const mcap::Reader& file);

// The named vehicle; with an empty name the only one. Throws ConfigError if the file has not this one, or several.
std::string recorded_vehicle(const mcap::Reader& file, const std::string& name);

// The flights of all vehicles, by their names. A topic that was not recorded leaves its rows empty, and a member that its messages do
// not have is kNotGiven, or empty. Leaves out repeated samples (of a stamp that does not rise), and rows of motion with numbers that are not
// finite. Throws ConfigError if a message does not fit its schema, or a member is of another type.
std::map<std::string, Flight> read_flights(const mcap::Reader& file);
// The flight of one vehicle in the file.
Flight read_flight(const mcap::Reader& file, const std::string& vehicle);

// The values of the first metadata of this name; empty if there is none.
std::map<std::string, std::string> metadata_of(const mcap::Reader& file, const std::string& name);

}  // namespace swiftlet::record

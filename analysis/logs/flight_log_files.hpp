// Logs of flights for identification: MCAP files of recorded messages, and CSV logs of other tools.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/record/flight.hpp"

namespace swiftlet::analysis {

// Converts a flight to one row per IMU sample. The rows start with the first IMU sample at which every
// recorded stream has a sample. Supply voltages are interpolated linearly, commands and rotor speeds are
// held.
identification::FlightLog flight_log_of(const record::Flight& flight);

// The body axes of a log's IMU samples.
enum class BodyAxes {
  kDetected,  // from the column names, or else from the sign of gravity along z, with x forward
  kFrd,       // forward, right, down
  kFlu,       // forward, left, up
};

struct ReadFlightLog {
  identification::FlightLog log;
  std::vector<std::string> assumptions;  // made while reading, as sentences
};

// Reads a CSV file with columns as in io/measurements.hpp, plain or compressed by gzip. Required: time,
// specific force and body rates along x, y and z, and per motor a command or a pulse width. The ESC of `base`
// converts pulse widths to throttles. Optional: supply voltage, rotor speeds, running, and pose_time with
// position and orientation.
// Or reads an MCAP file of recorded messages, whose axes are forward, right, down; vehicle: of those in the file, may be
// empty if it has only one. A folder stands for the flight.mcap in it. Throws io::ConfigError.
ReadFlightLog read_flight_log(const std::filesystem::path& file, const plant::Vehicle& base, BodyAxes axes,
                              const std::string& vehicle = {});

}  // namespace swiftlet::analysis

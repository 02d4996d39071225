// Logs of flights as files: the sensors.csv of a record, and what others have logged.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/recording/flight_log.hpp"
#include "swiftlet/recording/sensor_record.hpp"

namespace swiftlet::ground {

inline constexpr const char* kSensorsFile = "sensors.csv";

// One row an IMU sample, from the first on at which all that came at all had come. Voltages between two
// samples lie on the straight line.
identification::FlightLog flight_log_of(const SensorRecord& record);

// As CSV, each column headed `name [unit]`. A pose stands in all rows up to the next. Throws
// std::runtime_error.
void write_flight_log(const std::filesystem::path& file, const identification::FlightLog& log);

// Axes of the body in which a log has its IMU.
enum class BodyAxes {
  kAsSaid,  // by the columns' names; where they do not say, as gravity has it, x forward
  kFrd,     // forward, right, down
  kFlu,     // forward, left, up
};

struct ReadFlightLog {
  identification::FlightLog log;
  std::vector<std::string> assumptions;  // sentences
};

// A CSV whose columns are declared as io/measurements.hpp has them, compressed by gzip or not:
// time, the specific force and body rates along x, y and z, a command for each motor (or a pulse width, which
// the ESC of `base` makes a throttle), and whatever else of supply voltage, rotor speeds, running, pose_time
// with position and orientation is there. Of a folder, its sensors.csv. Throws runtime::ConfigError.
ReadFlightLog read_flight_log(const std::filesystem::path& file, const plant::Vehicle& base, BodyAxes axes);

}  // namespace swiftlet::ground

// Finds the rows of a log that are flight.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/identification/flight_log.hpp"

namespace swiftlet::identification {

// Rows from first up to, but not including, last.
struct Rows {
  std::size_t first = 0;
  std::size_t last = 0;

  std::size_t size() const { return last - first; }
};

struct FlightWindow {
  Rows flight;                        // from the first to the last row in the air with rotors running
  bool ends_in_impact = false;        // an impact cut the flight short
  std::vector<std::string> left_out;  // sentences: parts of the flight that are not used, and why
};

// Bounds given by the user, s, by the clock of the log.
struct FlightBounds {
  std::optional<double> from_s;
  std::optional<double> until_s;
};

// Finds the flight. With poses, the vehicle is in the air while it is more than kAirborneHeightM above the
// point where the rotors started. Without poses, it is in the air from the first to the last command above
// 0.9 of the median, less a short time at the start and kLandingS at the end. A specific force above kImpact
// ends the flight shortly before it. Throws BadData if less than kShortestFlightS is left.
FlightWindow find_flight(const FlightLog& log, const FlightBounds& bounds);

constexpr double kAirborneHeightM = 0.1;
constexpr double kLandingS = 1.0;
constexpr double kImpact = 40.0;  // m/s^2
constexpr double kShortestFlightS = 5.0;

}  // namespace swiftlet::identification

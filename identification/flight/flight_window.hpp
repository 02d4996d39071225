// Which rows of a log are flight.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/recording/flight_log.hpp"

namespace swiftlet::identification {

// Rows from first up to last, that one not included.
struct Rows {
  std::size_t first = 0;
  std::size_t last = 0;

  std::size_t size() const { return last - first; }
};

struct FlightWindow {
  Rows flight;  // in the air, rotors running, between the first and the last of it
  bool ends_in_a_blow = false;
  std::vector<std::string> left_out;  // of what was flown, and why; sentences
};

// What the user knows better; seconds of the log's own clock.
struct FlightBounds {
  std::optional<double> from_s;
  std::optional<double> until_s;
};

// In the air is, with poses, what is more than kAirborneHeightM above where the rotors were started; without,
// what lies between the first and the last command that is about the median one, less kLandingS. A blow of
// more than kBlow ends the flight before it. Throws BadData if less than kShortestFlightS is left.
FlightWindow find_flight(const FlightLog& log, const FlightBounds& bounds);

constexpr double kAirborneHeightM = 0.1;
constexpr double kLandingS = 1.0;
constexpr double kBlow = 40.0;  // m/s^2
constexpr double kShortestFlightS = 5.0;

}  // namespace swiftlet::identification

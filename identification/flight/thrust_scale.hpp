// The thrust scale of an autopilot that takes a collective throttle from 0 to 1, from a log of a flight: which throttle
// carries the weight, and by how much the thrust grows with it there.
#pragma once

#include <cstddef>
#include <vector>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Series of one log, each by its own times, s; all rise.
struct ThrottleRecord {
  std::vector<double> throttle_time_s, throttle;         // 0 .. 1
  std::vector<double> force_time_s, specific_force_up;   // m/s^2, along -z of the body
  std::vector<double> voltage_time_s, supply_voltage_v;  // may be empty
  double from_s = 0.0, until_s = 0.0;                    // in the air
};

struct ThrustScale {
  double hover_throttle = 0.0;
  double hover_deviation = 0.0;  // standard
  bool slope_known = false;      // its standard deviation is below a fifth of it
  double slope_n = 0.0;          // N per 1 of throttle, at hover
  double slope_deviation = 0.0;  // standard
  double residual_n = 0.0;       // root mean square
  double least_throttle = 0.0, greatest_throttle = 0.0;
  double supply_voltage_v = 0.0;  // mean; 0: not logged
  double curve_throttle = 0.0;    // of the vehicle file for the weight, at that voltage
  double curve_slope_n = 0.0;     // of the vehicle file there, N per 1 of throttle
  std::size_t blocks = 0;         // means over 0.1 s that were fitted
};

// The vehicle gives mass, motor lag and the throttle of its curve. Fits a line through means over 0.1 s of the specific force
// against the throttle behind the motor lag. Throws BadData with a sentence if there are less than 2 s of flight.
ThrustScale fit_thrust_scale(const ThrottleRecord& record, const plant::Vehicle& vehicle);

}  // namespace swiftlet::identification

// Parameters of a fit to flights.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/identification/fitting/series_fit.hpp"

namespace swiftlet::identification {

struct FlightParameter {
  std::string name;
  std::string unit;
  double start = 0.0;
  double scale = 1.0;  // expected size of the error of start
  double low = 0.0;    // lower bound
  double high = 0.0;   // upper bound
};

// Index of a parameter that is not identifiable from the logs.
constexpr int kAbsent = -1;

// Appends the parameter and returns its index.
int add(FlightParameter parameter, std::vector<FlightParameter>& parameters);

// Returns a problem with the start, scales and bounds of these parameters, without residuals.
SeriesProblem problem_of(const std::vector<FlightParameter>& parameters);

}  // namespace swiftlet::identification

// One parameter of a fit to flights, and the problem that several make.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/identification/fitting/series_fit.hpp"

namespace swiftlet::identification {

struct FlightParameter {
  std::string name;
  std::string unit;
  double start = 0.0;
  double scale = 1.0;  // by how much it may be off
  double low = 0.0;    // bounds
  double high = 0.0;
};

// Where a parameter stands among all; kAbsent: the logs cannot tell it.
constexpr int kAbsent = -1;

// Returns where it stands.
int add(FlightParameter parameter, std::vector<FlightParameter>& parameters);

// Of these parameters, as yet without residuals.
SeriesProblem problem_of(const std::vector<FlightParameter>& parameters);

}  // namespace swiftlet::identification

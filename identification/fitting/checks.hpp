// What bench data must be before anything is fitted to them. All throw BadData.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

// A column of readings, as the checks name it.
struct Column {
  const char* name;
  const char* unit;
  const std::vector<double>& values;
};

// Of one length, of at least so many rows, all finite.
void require_rows(const std::vector<Column>& columns, std::size_t least);

// Not the same everywhere: at least so many values that differ by more than a thousandth of what most
// readings span.
void require_variety(const Column& column, std::size_t least = 2);

// For what was set: each value within limits. because is the reason: "a throttle is a share".
void require_each_between(const Column& column, double min, double max, const std::string& because);

// For what was read: the median within limits that physics sets. Single readings outside are left to the fit,
// which lists them as outliers.
void require_median_between(const Column& column, double min, double max, const std::string& because);

// What drives an ESC: its supply, of a vehicle, and the throttle, a share.
void require_drive(const Column& supply, const Column& throttle);

// A moment of inertia, kg m^2, against the hubs' distance from the centre: of no mass far beyond the hubs, nor
// all of it near the centre. column is what led to it.
void require_gyration(const char* column, const ParameterEstimate& inertia, double mass_kg,
                      double hub_distance_m);

double median(std::vector<double> values);

// Two measures of one thing, about their means.
struct Comparison {
  double correlation = 0.0;
  double ratio = 0.0;   // of the first over the second, where they go together
  double spread = 0.0;  // root mean square, the larger of both
};
Comparison compared(const std::vector<double>& first, const std::vector<double>& second);

// The magnitude that nine in ten readings do not exceed; 1 for a column of zeros.
double full_scale(const std::vector<double>& values);

}  // namespace swiftlet::identification

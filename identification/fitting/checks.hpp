// Checks of bench data before a fit. All require_ functions throw BadData.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

// A column of readings with the name and unit that messages use.
struct Column {
  const char* name;
  const char* unit;
  const std::vector<double>& values;
};

// Requires columns of equal length with at least `least` rows and finite values.
void require_rows(const std::vector<Column>& columns, std::size_t least);

// Requires at least `least` distinct values. Values are distinct if they differ by more than a thousandth of
// the range between the 5 % and 95 % quantiles.
void require_variety(const Column& column, std::size_t least = 2);

// Requires every value to be within the limits. For quantities that the experimenter sets. because: the
// reason for the limits, for the message ("it is the throttle delta of Eq. (8)").
void require_each_between(const Column& column, double min, double max, const std::string& because);

// Requires the median to be within physical limits. For measured quantities: the fit lists single readings
// outside the limits as outliers.
void require_median_between(const Column& column, double min, double max, const std::string& because);

// Requires plausible inputs of an ESC: a supply voltage within the limits of limits.hpp and a throttle within
// 0 .. 1.
void require_drive(const Column& supply, const Column& throttle);

// Requires a plausible moment of inertia, kg m^2: its radius of gyration over the hubs' distance from the
// centre is within kLeastGyration .. kMostGyration. column: the measurement that the inertia is computed
// from, for the message.
void require_gyration(const char* column, const ParameterEstimate& inertia, double mass_kg,
                      double hub_distance_m);

double median(std::vector<double> values);

// Comparison of two measurements of the same quantity, with their means removed.
struct Comparison {
  double correlation = 0.0;
  double ratio = 0.0;   // regression coefficient of the first on the second
  double spread = 0.0;  // root mean square, the larger of the two
};
Comparison compared(const std::vector<double>& first, const std::vector<double>& second);

// 90 % quantile of the magnitudes; 1 if it is 0.
double full_scale(const std::vector<double>& values);

}  // namespace swiftlet::identification

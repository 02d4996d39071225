// Accuracy of the bench's instruments.
#pragma once

#include <optional>
#include <vector>

namespace swiftlet::identification {

// Standard deviations of single readings, where known. For the two readings of a row only their ratio
// matters. If one of them is unknown, both have the same error relative to full scale.
struct Instruments {
  std::optional<double> supply_voltage_v;
  std::optional<double> motor_voltage_v;
  std::optional<double> speed_rad_s;
  std::optional<double> thrust_n;
  std::optional<double> torque_n_m;
};

// Standard deviations of x and y, up to a common factor.
struct SpreadRatio {
  double x_spread = 0.0;
  double y_spread = 0.0;
};

SpreadRatio spreads(const std::optional<double>& of_x, const std::vector<double>& x,
                    const std::optional<double>& of_y, const std::vector<double>& y);

}  // namespace swiftlet::identification

// How far off the bench's instruments are.
#pragma once

#include <optional>
#include <vector>

namespace swiftlet::identification {

// Standard deviations of single readings, where known. For two readings of one row only their ratio matters.
// Where one of them is not known, each is taken to be off by the same share of its full scale.
struct Instruments {
  std::optional<double> supply_voltage_v;
  std::optional<double> motor_voltage_v;
  std::optional<double> speed_rad_s;
  std::optional<double> thrust_n;
  std::optional<double> torque_n_m;
};

struct SpreadRatio {
  double x_spread = 0.0;
  double y_spread = 0.0;
};

SpreadRatio spreads(const std::optional<double>& of_x, const std::vector<double>& x,
                    const std::optional<double>& of_y, const std::vector<double>& y);

}  // namespace swiftlet::identification

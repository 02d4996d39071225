// ESC, Eq. (7)-(9): v_a^2 = gain v_s^2 delta + offset, from readings of v_s, delta and v_a in the steady
// state (the paper's Figs. 2 and 3).
#pragma once

#include <vector>

#include "swiftlet/identification/bench/instruments.hpp"
#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

struct EscData {
  std::vector<double> supply_voltage_v;  // v_s
  std::vector<double> throttle;          // delta of Eq. (8), 0 .. 1, as set
  std::vector<double> motor_voltage_v;   // v_a
};

// Estimates esc.gain and esc.offset: the straight line through v_a^2 over v_s^2 delta, each reading weighted
// as its instruments are good (the same noise of v_a counts more in the square of a large v_a). measured and
// predicted are v_a^2. Findings compare with the naive v_a = c v_s delta. Throws BadData.
Experiment identify_esc(const EscData& data, const Instruments& instruments);

// Least squares of v_a = c v_s delta, through the rows that are not outliers: c, and the standard deviation
// of what it leaves, V.
struct NaiveEsc {
  double factor = 0.0;
  double residual_sd_v = 0.0;
};
NaiveEsc naive_esc(const EscData& data, const std::vector<std::size_t>& outliers);

}  // namespace swiftlet::identification

// Identifies the ESC, Eq. (7)-(9): v_a^2 = gain v_s^2 delta + offset, from steady-state readings of v_s,
// delta and v_a (the paper's Figs. 2 and 3).
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

// Estimates esc.gain and esc.offset: the straight line through v_a^2 over v_s^2 delta. Each reading is
// weighted by the accuracy of its instruments; as v_a is squared, its noise counts more where v_a is large.
// measured and predicted are v_a^2. The findings compare Eq. (9) with the naive v_a = c v_s delta. Throws
// BadData.
Experiment identify_esc(const EscData& data, const Instruments& instruments);

// Least-squares fit of v_a = c v_s delta to the rows that are not outliers: c, and the standard deviation of
// the residuals, V.
struct NaiveEsc {
  double factor = 0.0;
  double residual_sd_v = 0.0;
};
NaiveEsc naive_esc(const EscData& data, const std::vector<std::size_t>& outliers);

}  // namespace swiftlet::identification

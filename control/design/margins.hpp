// Stability margins of a closed loop.
#pragma once

#include <cmath>

#include "swiftlet/control/design/loop.hpp"

namespace swiftlet::control {

// Margins of a loop closed by u = -y. An unstable loop has none: phase at most 0, both gains 1, no delay.
struct LoopMargins {
  double phase_deg = 0.0;  // as phase_margin_deg(); infinite without a crossover
  double gain_increase =
      1.0;  // least factor above 1 on the loop gain that makes it unstable; infinite if none does
  double gain_decrease = 1.0;  // largest factor below 1, likewise; 0 if none does
  double delay_s = 0.0;        // s, least added delay that makes it unstable; infinite if none does
};

// All omega > 0, rad/s, ascending, at which L(j omega) is real: the imaginary zeros of L(s) - L(-s), so none
// is missed between grid points.
std::vector<double> phase_crossovers(const Loop& loop);

LoopMargins margins(const Loop& loop);

inline double decibels(double factor) { return 20.0 * std::log10(factor); }

}  // namespace swiftlet::control

// How far a closed loop is from the end of its stability.
#pragma once

#include "swiftlet/control/design/loop.hpp"

namespace swiftlet::control {

// Of a loop that is closed by u = -y. One that is not stable has none: phase at most 0, both gains 1, no
// delay.
struct LoopMargins {
  double phase_deg = 0.0;  // as phase_margin_deg(); infinite without a crossover
  double gain_increase =
      1.0;  // the least factor above 1 on the loop's gain that it does not bear; infinite if it bears any
  double gain_decrease = 1.0;  // the largest below 1, likewise; 0 if it bears any
  double delay_s = 0.0;        // the least further delay that it does not bear; infinite if it bears any
};

// Every omega > 0, rad/s, at which L(j omega) is real, rising. They are the imaginary zeros of L(s) - L(-s),
// so none is missed between grid points.
std::vector<double> phase_crossovers(const Loop& loop);

LoopMargins margins(const Loop& loop);

}  // namespace swiftlet::control

// Compares the measured delay of the loop with the delay that the gains in force tolerate.
#pragma once

#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/services/control/loop_delay.hpp"

namespace swiftlet::services {

class DelayMonitor {
 public:
  struct Report {
    double p50_s = -1.0;  // measured; -1: not known
    double p95_s = -1.0;
    double margin_s = 0.0;  // control::least_flown_delay_margin()
    bool near_margin = false;
  };

  explicit DelayMonitor(const control::ObservedRotors& rotors) : rotors_(rotors) {}

  // Takes some 10 ms when the gains have changed. settled: they are not just changing to others; while they
  // are, the last margin holds. Logs when the delay comes near the margin, and when it is off it again.
  const Report& update(const LoopDelay::Figures& measured, const control::ControlGains& gains, bool settled);

  // Share of the margin above which the measured delay is too near to it: the loops keep 40 % of their phase margin.
  static constexpr double kNearShare = 0.6;
  // Below this share it is off it again, unless the gains change.
  static constexpr double kOffShare = 0.5;

 private:
  control::ObservedRotors rotors_;
  control::ControlGains gains_;  // of the margin
  bool known_ = false;
  Report report_;
};

}  // namespace swiftlet::services

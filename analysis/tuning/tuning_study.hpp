// The step responses, frequency responses and margins of control settings on one vehicle, for comparison.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "swiftlet/control/design/flown_loops.hpp"
#include "swiftlet/control/design/margins.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::analysis {

// The delay from a sample to the rotors, s.
struct LoopDelay {
  double sampling_s = 0.0;   // half a period of the IMU: a command holds until the next one
  double actuation_s = 0.0;  // from sample to actuator
  std::string flight = {};   // the record that measured it: "flights/A"; empty: it was given, or is 0

  double total_s() const { return sampling_s + actuation_s; }
};

// The response to a unit step of the reference. NaN: not reached within eight times the plotted time, or the
// loop is unstable.
struct StepFigures {
  double rise_time_s = 0.0;      // from 10 to 90 %
  double overshoot = 0.0;        // fraction
  double settling_time_s = 0.0;  // to stay within 5 %
};

// One loop of one set of control settings.
struct LoopStudy {
  bool stable = false;
  double crossover = 0.0;  // rad/s, the one of the phase margin; NaN: none
  control::LoopMargins margins;
  StepFigures step;
  std::vector<double> time_s, response;                // after a unit step; ends where it diverges
  std::vector<double> omega, magnitude_db, phase_deg;  // of the open loop; rad/s; phase continuous over omega
};

struct SettingsStudy {
  std::string name;
  std::array<LoopStudy, 6> loops;  // in the order of control::kFlownLoopNames
};

struct TuningStudy {
  std::string vehicle;
  double rotor_lag_s = 0.0;
  LoopDelay delay;
  std::vector<SettingsStudy> settings;
};

// Designs the gains of each settings and computes their loops. All curves of a loop have the same range.
// Throws std::invalid_argument as control::design() does.
TuningStudy study_tuning(const plant::Vehicle& vehicle, const std::vector<control::ControlSettings>& settings,
                         const LoopDelay& delay);

}  // namespace swiftlet::analysis

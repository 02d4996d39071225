// The figures of a tuning study as text.
#pragma once

#include <string>

#include "swiftlet/analysis/tuning/tuning_study.hpp"

namespace swiftlet::analysis {

// "rotor lag 82.1 ms, delay 1.5 ms (1.0 ms of sampling, 0.5 ms measured in flights/A)"
std::string delay_text(const TuningStudy& study);

// One table for each settings, with a newline at the end.
std::string tuning_table(const TuningStudy& study);

// JSON without a newline at the end:
//   vehicle, rotor_lag_s, delay.{sampling_s,actuation_s,flight}
//   settings[].name, settings[].loops.{roll,pitch,yaw,x,y,z}
//     stable, crossover_rad_s, phase_margin_deg, gain_increase_db, gain_decrease_db, delay_margin_s
//     rise_time_s, overshoot, settling_time_s
// null: there is no such figure, or no such change makes the loop unstable.
std::string tuning_json(const TuningStudy& study);

}  // namespace swiftlet::analysis

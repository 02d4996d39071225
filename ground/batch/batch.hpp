// A plan flown many times, each with a seed, and so a draw, of its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "swiftlet/control/design/mismatch.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"

namespace swiftlet::ground {

struct BatchRun {
  std::uint64_t seed = 0;
  bool completed = false;
  std::string reason;       // why not; empty if completed
  double rms_3d_m = 0.0;    // of the tracking error; NaN if the mission was not started
  double peak_3d_m = 0.0;   // likewise
  double duration_s = 0.0;  // of the mission, as far as it went
  control::PhaseMargins margins_deg;
  std::vector<double> values;  // of the plan's variates, as drawn
};

struct Batch {
  std::size_t asked = 0;
  std::vector<BatchRun> runs;          // that were flown to their end, by rising seed
  std::size_t rejected = 0;            // draws that broke a rule and were drawn anew
  control::PhaseMargins designed_deg;  // on the vehicle of the design
  double wall_s = 0.0;

  std::size_t failed() const;
};

struct BatchProgress {
  std::size_t asked = 0;
  std::size_t done = 0;
  std::size_t failed = 0;
  double elapsed_s = 0.0;
};

// Run i, from 0, has the seed plan.seed + i, for its draw as for all that is random in its simulation. All
// draws are made before the first flight: throws runtime::ConfigError for one that cannot be, and
// std::invalid_argument for control settings that cannot be flown.
class BatchRunner {
 public:
  BatchRunner(LaunchConfiguration plan, std::size_t runs);

  // Flies on so many threads; the outcome is the same whatever their number. `progress` is called now and
  // then from this thread, `cancelled` from all: once it is true, runs under way are dropped. Throws what a
  // run throws.
  Batch fly(std::size_t jobs, const std::function<bool()>& cancelled,
            const std::function<void(const BatchProgress&)>& progress) const;

 private:
  LaunchConfiguration plan_;
  std::size_t runs_;
  std::size_t rejected_ = 0;
  control::ControlDesign design_;
};

}  // namespace swiftlet::ground

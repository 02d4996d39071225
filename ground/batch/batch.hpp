// Monte Carlo batch: one launch configuration flown many times, each run with its own seed and sampled
// parameters.
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
  std::string reason;       // why the run failed; empty if completed
  double rms_3d_m = 0.0;    // tracking error; NaN if the mission did not start
  double peak_3d_m = 0.0;   // tracking error; NaN if the mission did not start
  double duration_s = 0.0;  // flown part of the mission
  control::PhaseMargins margins_deg;
  std::vector<double> values;  // sampled, in the order of the distributions
};

struct Batch {
  std::size_t requested = 0;           // requested runs
  std::vector<BatchRun> runs;          // finished runs, in order of the seed
  std::size_t rejected = 0;            // samples that broke a rule and were sampled again
  control::PhaseMargins designed_deg;  // of the nominal vehicle
  double wall_s = 0.0;

  std::size_t failed() const;
};

constexpr std::size_t kMostJobs = 1024;

struct BatchProgress {
  std::size_t requested = 0;
  std::size_t done = 0;
  std::size_t failed = 0;
  double elapsed_s = 0.0;
};

// Run i, from 0, uses the seed plan.seed + i for the parameter samples and for all random numbers of its
// simulation. The constructor samples all runs: it throws io::ConfigError if no valid sample is found,
// and std::invalid_argument for control settings that cannot be flown.
class BatchRunner {
 public:
  BatchRunner(LaunchConfiguration plan, std::size_t runs);

  // Flies the runs on `jobs` threads, fewer if the system starts no more; the result does not depend on their number. jobs: 1 ..
  // kMostJobs, else throws std::invalid_argument. Calls `progress` about every 100 ms from this thread, and `cancelled` from all
  // threads. Once `cancelled` returns true, unfinished runs are discarded. Rethrows the first exception of a run.
  Batch fly(std::size_t jobs, const std::function<bool()>& cancelled,
            const std::function<void(const BatchProgress&)>& progress) const;

 private:
  LaunchConfiguration plan_;
  std::size_t runs_;
  std::size_t rejected_ = 0;
  control::ControlDesign design_;
};

}  // namespace swiftlet::ground

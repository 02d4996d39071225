// The result of a batch as text, as JSON and as a CSV table of all runs.
#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "swiftlet/ground/batch/batch.hpp"
#include "swiftlet/ground/flight/launch_configuration.hpp"
#include "swiftlet/math/statistics.hpp"

namespace swiftlet::ground {

constexpr std::array<const char*, 6> kMarginNames = {"roll", "pitch", "yaw", "x", "y", "z"};
std::array<double, 6> as_array(const control::PhaseMargins& margins_deg);

// Rank correlations of a parameter with the RMS error. A parameter that increases the error in both
// directions shows in the correlation of the distance.
struct ParameterEffect {
  std::string name;
  double of_value = 0.0;
  double of_distance = 0.0;  // of |value - median|

  double strength() const;  // larger magnitude of both; -1 if neither is finite
};

struct BatchReport {
  std::string mission, vehicle, control, dispersion;  // names
  std::string shard;  // "2/4" if these are the runs of a part of a batch; otherwise empty
  std::string folder;
  double tolerance_m = 0.0;
  std::uint64_t first_seed = 0;
  Batch batch;
  std::vector<std::string> parameters;  // names of BatchRun::values

  math::Spread rms_3d_m, peak_3d_m;  // over all runs that started the mission
  std::array<math::Spread, 6> margins_deg;
  std::vector<ParameterEffect> effects;  // strongest first
  std::string repeat;                    // command that repeats a run, without the value of --seed

  bool interrupted() const { return batch.runs.size() < batch.requested; }
  bool completed() const { return !interrupted() && batch.failed() == 0; }
  std::string repeat_command(std::uint64_t seed) const { return repeat + std::to_string(seed); }
};

// Computes the spreads and effects from the runs.
void summarize(BatchReport& report);

// options: those from which `plan` was made.
BatchReport report_of(const LaunchConfiguration& plan, const FlyOptions& options, Batch batch);

// Lengths in m, angles in degrees; a value that is not finite is null.
nlohmann::ordered_json to_json(const BatchReport& report);

// A table for a terminal, errors in mm.
std::string to_text(const BatchReport& report);

// Writes one row per run: seed, completed (1 or 0), reason, rms_3d_m, peak_3d_m, duration_s, margin_roll_deg
// ..., and the sampled value of each parameter in the unit of its key. Numbers have the shortest form that
// reads back exactly; a value that is not finite is an empty cell. Throws std::runtime_error if the file
// cannot be written.
void write_batch_csv(const std::filesystem::path& file, const BatchReport& report);

}  // namespace swiftlet::ground

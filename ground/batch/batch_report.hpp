// What a batch came to: for the eye, for scripts and as a table of all runs.
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

// Rank correlations with the RMS error. What does harm in either direction shows in the distance.
struct ParameterEffect {
  std::string name;
  double of_value = 0.0;
  double of_distance = 0.0;  // of the value from its median

  double strength() const;  // the larger of both, without sign; -1 if there is none
};

struct BatchReport {
  std::string mission, vehicle, control, dispersion;  // names
  std::string folder;
  double tolerance_m = 0.0;
  std::uint64_t first_seed = 0;
  Batch batch;
  std::vector<std::string> parameters;  // of BatchRun::values

  Spread rms_3d_m, peak_3d_m;  // over all runs that started their mission
  std::array<Spread, 6> margins_deg;
  std::vector<ParameterEffect> effects;  // the strongest first
  std::string repeat;                    // the command that flies one of the runs, up to the value of --seed

  bool interrupted() const { return batch.runs.size() < batch.asked; }
  bool completed() const { return !interrupted() && batch.failed() == 0; }
  std::string repeat_command(std::uint64_t seed) const { return repeat + std::to_string(seed); }
};

// options: those that the plan was made from.
BatchReport report_of(const LaunchConfiguration& plan, const FlyOptions& options, Batch batch);

// Lengths in m, angles in degrees; what is not finite is null.
nlohmann::ordered_json to_json(const BatchReport& report);

// A table for a terminal, errors in mm.
std::string to_text(const BatchReport& report);

// One row a run: seed, completed (1 or 0), reason, rms_3d_m, peak_3d_m, duration_s, margin_roll_deg ..., and
// the value of each parameter that was varied, in the unit of its key. Numbers in the shortest form that
// reads back as the same, an empty cell for one that is not finite. Throws std::runtime_error if the file
// cannot be written.
void write_batch_csv(const std::filesystem::path& file, const BatchReport& report);

}  // namespace swiftlet::ground

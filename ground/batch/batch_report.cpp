#include "swiftlet/ground/batch/batch_report.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/io/format.hpp"

namespace swiftlet::ground {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kPlainCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+./:,@%=";

// Quotes the text if a shell would not take it as one word.
std::string shell_word(const std::string& text) {
  if (!text.empty() && text.find_first_not_of(kPlainCharacters) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

std::string numbers(const std::vector<Eigen::Vector3d>& vectors) {
  std::string text;
  for (const Eigen::Vector3d& vector : vectors) {
    for (const double number : vector) text += (text.empty() ? "" : ",") + io::exact(number);
  }
  return text;
}

std::string repeat_of(const FlyOptions& options) {
  const FlyOptions usual;
  std::string command = "swiftlet sim fly " + shell_word(options.mission);
  const ReadingOptions& reading = options.reading;
  if (reading.frame) command += std::string(" --frame ") + io::frame_name(*reading.frame);
  if (reading.tolerance_m) command += " --tolerance " + io::exact(*reading.tolerance_m);
  if (!reading.columns.empty()) command += " --columns " + shell_word(reading.columns);
  if (reading.from_s) command += " --from " + io::exact(*reading.from_s);
  if (reading.until_s) command += " --until " + io::exact(*reading.until_s);
  const io::Placement& placement = reading.placement;
  if (placement.scale != 1.0) command += " --scale " + io::exact(placement.scale);
  if (placement.rotate_deg != 0.0) command += " --rotate " + io::exact(placement.rotate_deg);
  if (!placement.offset_ned.isZero(0.0)) command += " --offset " + numbers({placement.offset_ned});
  if (reading.fence) command += " --fence " + numbers({reading.fence->min_ned, reading.fence->max_ned});
  if (reading.time_scale != usual.reading.time_scale)
    command += " --time-scale " + io::exact(reading.time_scale);
  if (reading.as_fast_as_possible)
    command += " --as-fast-as-possible --reserve " + io::exact(reading.reserve);
  const auto add = [&](const char* option, const std::string& value, const std::string& usual_value) {
    if (value != usual_value) command += std::string(" ") + option + " " + shell_word(value);
  };
  add("--vehicle", options.vehicle, usual.vehicle);
  add("--control", options.control, usual.control);
  add("--simulation", options.simulation, usual.simulation);
  add("--imu-rate", std::to_string(options.imu_rate_hz), std::to_string(usual.imu_rate_hz));
  add("--dispersion", options.dispersion, usual.dispersion);
  return command + " --seed ";
}

template <typename Value>
std::vector<double> column(const Batch& batch, const Value& value_of) {
  std::vector<double> numbers;
  numbers.reserve(batch.runs.size());
  for (const BatchRun& run : batch.runs) numbers.push_back(value_of(run));
  return numbers;
}

std::vector<ParameterEffect> effects_of(const BatchReport& report) {
  const std::vector<double> rms = column(report.batch, [](const BatchRun& run) { return run.rms_3d_m; });
  std::vector<ParameterEffect> effects;
  for (std::size_t i = 0; i < report.parameters.size(); ++i) {
    std::vector<double> values = column(report.batch, [i](const BatchRun& run) { return run.values[i]; });
    const double of_value = math::rank_correlation(values, rms);
    const double median = math::spread(values).median;
    for (double& value : values) value = std::abs(value - median);
    effects.push_back({report.parameters[i], of_value, math::rank_correlation(values, rms)});
  }
  std::stable_sort(effects.begin(), effects.end(), [](const ParameterEffect& a, const ParameterEffect& b) {
    return a.strength() > b.strength();
  });
  return effects;
}

Json json_of(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of(const math::Spread& spread) {
  return {{"n", spread.count},          {"min", json_of(spread.min)},
          {"p5", json_of(spread.p5)},   {"median", json_of(spread.median)},
          {"p95", json_of(spread.p95)}, {"max", json_of(spread.max)}};
}

std::string row_of(const char* name, const char* unit, const math::Spread& spread, double scale) {
  return fmt::format("  {:<22} {:>3} {:6}", name, unit, spread.count) +
         fmt::format(" {:8.2f} {:8.2f} {:8.2f} {:8.2f} {:8.2f}", spread.min * scale, spread.p5 * scale,
                     spread.median * scale, spread.p95 * scale, spread.max * scale);
}

std::string headline_of(const BatchReport& report) {
  const Batch& batch = report.batch;
  const std::uint64_t first = report.first_seed;
  const std::string shard = report.shard.empty() ? "" : ", shard " + report.shard;
  std::string text =
      report.mission + ", " + report.vehicle + " with " + report.control + ", dispersion " +
      report.dispersion +
      fmt::format("{}: {}, seeds {} to {}\n", shard, io::counted(batch.requested, "run").c_str(),
                  static_cast<unsigned long long>(first),
                  static_cast<unsigned long long>(first + batch.requested - 1));
  text += fmt::format("  {} completed, {} failed", batch.runs.size() - batch.failed(), batch.failed());
  if (report.interrupted())
    text += fmt::format(", {} NOT flown: batch cancelled", batch.requested - batch.runs.size());
  return text + fmt::format("; {:.1f} s\n", batch.wall_s);
}

std::string effect_cell(double correlation) {
  return std::isfinite(correlation) ? fmt::format(" {:+9.2f}", correlation) : fmt::format(" {:>9}", "-");
}

std::string effects_text(const BatchReport& report) {
  std::string text =
      fmt::format("\nrank correlation with the RMS error (independent: within +-{:.2f} in 95 % of cases)\n",
                  math::chance_correlation(report.rms_3d_m.count)) +
      fmt::format(" {:>9} {:>9}  distance: |value - median|\n", "value", "distance");
  for (const ParameterEffect& effect : report.effects)
    text += effect_cell(effect.of_value) + effect_cell(effect.of_distance) + "  " + effect.name + "\n";
  return text;
}

std::string failures_text(const BatchReport& report) {
  std::string text = "\nfailed runs, and the command that repeats each\n";
  for (const BatchRun& run : report.batch.runs) {
    if (!run.completed)
      text += "  seed " + std::to_string(run.seed) + ": " + run.reason + ": " +
              report.repeat_command(run.seed) + "\n";
  }
  return text;
}

}  // namespace

std::array<double, 6> as_array(const control::PhaseMargins& m) {
  return {m.roll, m.pitch, m.yaw, m.x, m.y, m.z};
}

double ParameterEffect::strength() const {
  const double value = std::isfinite(of_value) ? std::abs(of_value) : -1.0;
  const double distance = std::isfinite(of_distance) ? std::abs(of_distance) : -1.0;
  return std::max(value, distance);
}

BatchReport report_of(const LaunchConfiguration& plan, const FlyOptions& options, Batch batch) {
  BatchReport report;
  report.mission = plan.mission.name;
  report.vehicle = plan.vehicle.name;
  report.control = plan.control.name;
  report.dispersion = plan.dispersion.name;
  report.folder = plan.folder.string();
  report.tolerance_m = plan.mission.tolerance_m;
  report.first_seed = plan.seed;
  report.batch = std::move(batch);
  for (const simulation::ParameterDistribution& distribution : plan.dispersion.distributions)
    report.parameters.push_back(distribution.what().name);
  report.repeat = repeat_of(options);
  summarize(report);
  return report;
}

void summarize(BatchReport& report) {
  report.rms_3d_m = math::spread(column(report.batch, [](const BatchRun& run) { return run.rms_3d_m; }));
  report.peak_3d_m = math::spread(column(report.batch, [](const BatchRun& run) { return run.peak_3d_m; }));
  for (std::size_t i = 0; i < kMarginNames.size(); ++i) {
    report.margins_deg[i] =
        math::spread(column(report.batch, [i](const BatchRun& run) { return as_array(run.margins_deg)[i]; }));
  }
  report.effects = effects_of(report);
}

Json to_json(const BatchReport& report) {
  const Batch& batch = report.batch;
  Json json;
  json["completed"] = report.completed();
  json["interrupted"] = report.interrupted();
  json["mission"] = report.mission;
  json["vehicle"] = report.vehicle;
  json["control"] = report.control;
  json["dispersion"] = report.dispersion;
  if (!report.shard.empty()) json["shard"] = report.shard;
  json["seed"] = report.first_seed;
  json["runs"] = batch.requested;
  json["runs_done"] = batch.runs.size();
  json["runs_failed"] = batch.failed();
  json["draws_rejected"] = batch.rejected;
  json["out_dir"] = report.folder;
  json["wall_s"] = batch.wall_s;
  json["tolerance_m"] = report.tolerance_m;
  json["rms_3d_m"] = json_of(report.rms_3d_m);
  json["peak_3d_m"] = json_of(report.peak_3d_m);
  Json& margins = json["phase_margin_deg"];
  Json& designed = json["phase_margin_designed_deg"];
  for (std::size_t i = 0; i < kMarginNames.size(); ++i) {
    margins[kMarginNames[i]] = json_of(report.margins_deg[i]);
    designed[kMarginNames[i]] = json_of(as_array(batch.designed_deg)[i]);
  }
  Json& effects = json["rank_correlation_with_rms"] = Json::object();
  for (const ParameterEffect& effect : report.effects)
    effects[effect.name] = {{"value", json_of(effect.of_value)}, {"distance", json_of(effect.of_distance)}};
  Json& failures = json["failures"] = Json::array();
  for (const BatchRun& run : batch.runs) {
    if (!run.completed)
      failures.push_back(
          {{"seed", run.seed}, {"reason", run.reason}, {"repeat", report.repeat_command(run.seed)}});
  }
  return json;
}

std::string to_text(const BatchReport& report) {
  constexpr double kMm = 1e3;
  std::string text = headline_of(report);
  if (report.batch.rejected > 0)
    text += "  sampled again: " + io::counted(report.batch.rejected, "sample") + " that broke a rule\n";
  text += fmt::format("\n  {:<22} {:>3} {:>6} {:>8} {:>8} {:>8} {:>8} {:>8} {:>9}\n", "", "", "runs", "min",
                      "p5", "median", "p95", "max", "nominal");
  text += row_of("tracking error, RMS", "mm", report.rms_3d_m, kMm) + "\n";
  text += row_of("tracking error, peak", "mm", report.peak_3d_m, kMm) +
          fmt::format("   (tolerance {:.0f})\n", report.tolerance_m * kMm);
  const std::array<double, 6> designed = as_array(report.batch.designed_deg);
  for (std::size_t i = 0; i < kMarginNames.size(); ++i) {
    const std::string name = std::string("phase margin, ") + kMarginNames[i];
    text += row_of(name.c_str(), "deg", report.margins_deg[i], 1.0) + fmt::format(" {:9.2f}\n", designed[i]);
  }
  text += effects_text(report);
  if (report.batch.failed() > 0) text += failures_text(report);
  return text + "\nrecord  " + report.folder + "\n";
}

void write_batch_csv(const std::filesystem::path& file, const BatchReport& report) {
  std::vector<std::string> columns = {"seed", "completed", "reason", "rms_3d_m", "peak_3d_m", "duration_s"};
  for (const char* name : kMarginNames) columns.push_back(std::string("margin_") + name + "_deg");
  columns.insert(columns.end(), report.parameters.begin(), report.parameters.end());
  io::CsvWriter csv(file, columns);
  const auto write_if_finite = [&csv](double value) {
    std::isfinite(value) ? csv.exact(value) : csv.empty();
  };
  for (const BatchRun& run : report.batch.runs) {
    csv.text(std::to_string(run.seed)).text(run.completed ? "1" : "0").quoted(run.reason);
    for (const double value : {run.rms_3d_m, run.peak_3d_m, run.duration_s}) write_if_finite(value);
    for (const double margin : as_array(run.margins_deg)) write_if_finite(margin);
    for (const double value : run.values) write_if_finite(value);
    csv.end_row();
  }
  csv.finish();
}

}  // namespace swiftlet::ground

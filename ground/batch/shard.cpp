#include "swiftlet/ground/batch/shard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFormat = 1;

// JSON has no numbers that are not finite.
Json exact_json(double number) {
  if (std::isfinite(number)) return number;
  return std::isnan(number) ? "nan" : number > 0.0 ? "inf" : "-inf";
}

Json exact_json(const std::vector<double>& numbers) {
  Json list = Json::array();
  for (const double number : numbers) list.push_back(exact_json(number));
  return list;
}

Json exact_json(const control::PhaseMargins& margins_deg) {
  const std::array<double, 6> all = as_array(margins_deg);
  return exact_json(std::vector<double>(all.begin(), all.end()));
}

double number_of(const Json& json) {
  if (json == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (json == "inf") return std::numeric_limits<double>::infinity();
  if (json == "-inf") return -std::numeric_limits<double>::infinity();
  return json.get<double>();
}

std::vector<double> numbers_of(const Json& json, std::size_t count, const char* key) {
  std::vector<double> numbers;
  for (const Json& entry : json.at(key)) numbers.push_back(number_of(entry));
  if (numbers.size() != count)
    throw io::InputError(fmt::format("{}: has {} numbers, must have {}", key, numbers.size(), count));
  return numbers;
}

control::PhaseMargins margins_of(const Json& json, const char* key) {
  const std::vector<double> all = numbers_of(json, kMarginNames.size(), key);
  return {all[0], all[1], all[2], all[3], all[4], all[5]};
}

Json exact_json(const BatchRun& run) {
  return {{"seed", run.seed},
          {"completed", run.completed},
          {"reason", run.reason},
          {"rms_3d_m", exact_json(run.rms_3d_m)},
          {"peak_3d_m", exact_json(run.peak_3d_m)},
          {"duration_s", exact_json(run.duration_s)},
          {"margins_deg", exact_json(run.margins_deg)},
          {"values", exact_json(run.values)}};
}

BatchRun run_of(const Json& json, std::size_t values) {
  BatchRun run;
  run.seed = json.at("seed");
  run.completed = json.at("completed");
  run.reason = json.at("reason");
  run.rms_3d_m = number_of(json.at("rms_3d_m"));
  run.peak_3d_m = number_of(json.at("peak_3d_m"));
  run.duration_s = number_of(json.at("duration_s"));
  run.margins_deg = margins_of(json, "margins_deg");
  run.values = numbers_of(json, values, "values");
  return run;
}

BatchReport report_of(const Json& json) {
  BatchReport report;
  report.mission = json.at("mission");
  report.vehicle = json.at("vehicle");
  report.control = json.at("control");
  report.dispersion = json.at("dispersion");
  report.tolerance_m = number_of(json.at("tolerance_m"));
  report.repeat = json.at("repeat");
  report.parameters = json.at("parameters").get<std::vector<std::string>>();
  report.batch.rejected = json.at("draws_rejected");
  report.batch.wall_s = number_of(json.at("wall_s"));
  report.batch.designed_deg = margins_of(json, "designed_margins_deg");
  for (const Json& run : json.at("runs")) report.batch.runs.push_back(run_of(run, report.parameters.size()));
  report.batch.requested = report.batch.runs.size();
  return report;
}

ShardResult result_of(const Json& json) {
  if (const int format = json.at("format"); format != kFormat)
    throw io::InputError(fmt::format("format: is {}, must be {}", format, kFormat));
  ShardResult result;
  result.shard = parse_shard(json.at("shard"));
  result.batch_runs = json.at("batch_runs");
  result.batch_seed = json.at("batch_seed");
  result.program = json.at("program");
  result.inputs = json.at("inputs").get<std::map<std::string, std::string>>();
  result.report = report_of(json);
  result.report.shard = result.shard.text();

  const std::vector<BatchRun>& runs = result.report.batch.runs;
  const std::size_t expected = result.shard.run_count(result.batch_runs);
  if (runs.size() != expected)
    throw io::InputError(fmt::format("runs: has {} of {} runs", runs.size(), expected));
  result.report.first_seed = result.batch_seed + result.shard.first_run(result.batch_runs);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (runs[i].seed != result.report.first_seed + i)
      throw io::InputError(fmt::format("runs: number {} has seed {}, must have {}", i + 1, runs[i].seed,
                                       result.report.first_seed + i));
  }
  return result;
}

// What differs between two shards that cannot be of one batch; empty if nothing does.
std::string difference(const ShardResult& a, const ShardResult& b) {
  if (a.shard.count != b.shard.count)
    return fmt::format("one is of {} shards, the other of {}", a.shard.count, b.shard.count);
  if (a.batch_runs != b.batch_runs)
    return fmt::format("--runs is {} for one, {} for the other", a.batch_runs, b.batch_runs);
  if (a.batch_seed != b.batch_seed)
    return fmt::format("--seed is {} for one, {} for the other", a.batch_seed, b.batch_seed);
  if (a.program != b.program)
    return fmt::format("one was flown by {}, the other by {}", a.program, b.program);
  if (a.report.repeat != b.report.repeat)
    return fmt::format("one repeats runs with '{}', the other with '{}'", a.report.repeat, b.report.repeat);
  for (const auto& [role, content] : a.inputs) {
    const auto other = b.inputs.find(role);
    if (other == b.inputs.end() || other->second != content) return "their " + role + " files differ";
  }
  return "";
}

}  // namespace

Shard parse_shard(const std::string& text) {
  const auto refuse = [&text](const std::string& what) {
    throw io::InputError("shard '" + text + "': " + what);
  };
  const std::size_t slash = text.find('/');
  const auto is_count = [](const std::string& word) {
    return !word.empty() && word.size() <= 6 && word.find_first_not_of("0123456789") == std::string::npos;
  };
  if (slash == std::string::npos || !is_count(text.substr(0, slash)) || !is_count(text.substr(slash + 1)))
    refuse("must be I/N, such as 2/4");
  const Shard shard{std::stoul(text.substr(0, slash)), std::stoul(text.substr(slash + 1))};
  if (shard.count < 1 || shard.count > kMostShards)
    refuse(fmt::format("the number of shards must be from 1 to {}", kMostShards));
  if (shard.index < 1 || shard.index > shard.count)
    refuse(fmt::format("the shard must be from 1 to {}", shard.count));
  return shard;
}

std::map<std::string, std::string> read_inputs(const LaunchConfiguration& plan) {
  std::map<std::string, fs::path> files = {{"mission", plan.mission_file},
                                           {"vehicle", plan.vehicle_file},
                                           {"control", plan.control_file},
                                           {"simulation", plan.simulation_file}};
  if (!plan.dispersion_file.empty()) files["dispersion"] = plan.dispersion_file;
  std::map<std::string, std::string> inputs;
  for (const auto& [role, file] : files) inputs[role] = io::read_text_file(file);
  return inputs;
}

void write_shard(const fs::path& folder, const ShardResult& result) {
  const BatchReport& report = result.report;
  Json json;
  json["format"] = kFormat;
  json["shard"] = result.shard.text();
  json["batch_runs"] = result.batch_runs;
  json["batch_seed"] = result.batch_seed;
  json["program"] = result.program;
  json["mission"] = report.mission;
  json["vehicle"] = report.vehicle;
  json["control"] = report.control;
  json["dispersion"] = report.dispersion;
  json["tolerance_m"] = exact_json(report.tolerance_m);
  json["repeat"] = report.repeat;
  json["draws_rejected"] = report.batch.rejected;
  json["wall_s"] = exact_json(report.batch.wall_s);
  json["designed_margins_deg"] = exact_json(report.batch.designed_deg);
  json["parameters"] = report.parameters;
  Json& runs = json["runs"] = Json::array();
  for (const BatchRun& run : report.batch.runs) runs.push_back(exact_json(run));
  json["inputs"] = result.inputs;
  io::write_atomically(folder / kShardFile, io::json_text(json, 1) + "\n");
}

ShardResult read_shard(const fs::path& folder) {
  const fs::path file = folder / kShardFile;
  const std::string text = io::read_text_file(file.string());
  try {
    return result_of(Json::parse(text));
  } catch (const std::exception& error) {
    throw io::InputError(file.string() + ": is no result of a shard: " + io::printable(error.what()));
  }
}

BatchReport merge(std::vector<ShardResult> shards, const std::vector<fs::path>& folders) {
  if (shards.empty()) throw io::InputError("no shard is given");
  const ShardResult& first = shards.front();
  std::map<std::size_t, std::size_t> order;  // place in `shards`, by index of the shard
  for (std::size_t i = 0; i < shards.size(); ++i) {
    if (const std::string what = difference(first, shards[i]); !what.empty())
      throw io::InputError(
          fmt::format("{} and {} are not of one batch: {}", folders[0].string(), folders[i].string(), what));
    const auto [known, is_new] = order.emplace(shards[i].shard.index, i);
    if (!is_new)
      throw io::InputError(fmt::format("shard {} is given twice: {} and {}", shards[i].shard.text(),
                                       folders[known->second].string(), folders[i].string()));
  }
  const std::size_t count = first.shard.count;
  for (std::size_t index = 1; index <= count; ++index) {
    if (order.count(index) == 0)
      throw io::InputError(fmt::format("shard {} is missing: {} of {} are given", Shard{index, count}.text(),
                                       shards.size(), count));
  }

  BatchReport whole = first.report;
  whole.shard.clear();
  whole.first_seed = first.batch_seed;
  whole.batch.requested = first.batch_runs;
  whole.batch.runs.clear();
  whole.batch.rejected = 0;
  whole.batch.wall_s = 0.0;
  for (const auto& [index, place] : order) {
    Batch& part = shards[place].report.batch;
    whole.batch.rejected += part.rejected;
    whole.batch.wall_s += part.wall_s;
    std::move(part.runs.begin(), part.runs.end(), std::back_inserter(whole.batch.runs));
  }
  summarize(whole);
  return whole;
}

}  // namespace swiftlet::ground

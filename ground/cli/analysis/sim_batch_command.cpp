#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <thread>

#include <fmt/core.h>

#include "swiftlet/ground/batch/batch.hpp"
#include "swiftlet/ground/batch/batch_report.hpp"
#include "swiftlet/ground/batch/shard.hpp"
#include "swiftlet/ground/cli/analysis/batch_output.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/io/command_line/progress_line.hpp"
#include "swiftlet/io/format.hpp"
#include "swiftlet/plant/simulation/no_effect.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kMostRuns = 1'000'000;
constexpr std::size_t kBarLength = 30;
constexpr std::size_t kStages = 5;  // progress lines in all if standard error is no terminal

struct BatchOptions {
  FlyOptions flight;
  std::size_t runs = 100;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
  std::string shard;  // "I/N"; empty: the whole batch
};

std::string bar(const BatchProgress& progress) {
  const std::size_t filled = kBarLength * progress.done / progress.requested;
  std::string text = "[" + std::string(filled, '#') + std::string(kBarLength - filled, '.') + "] " +
                     fmt::format("{}/{} runs, {} failed", progress.done, progress.requested, progress.failed);
  if (progress.done > 0 && progress.done < progress.requested) {
    const double left_s = progress.elapsed_s * static_cast<double>(progress.requested - progress.done) /
                          static_cast<double>(progress.done);
    text += fmt::format(", {:.0f} s left", left_s);
  }
  return text;
}

// The shard that the options ask for; all runs if they do not.
Shard shard_of(const BatchOptions& options) {
  if (options.shard.empty()) return {};
  const Shard shard = parse_shard(options.shard);
  if (shard.count > options.runs)
    throw io::InputError(fmt::format("shard '{}': {} cannot be shared by {} shards", options.shard,
                                     io::counted(options.runs, "run"), shard.count));
  return shard;
}

// Writes the result of a shard for `swiftlet sim merge`. One that was cancelled leaves no file.
int finish_shard(const ShardResult& result, bool json, io::ProgressLine& progress) {
  const BatchReport& report = result.report;
  if (!report.interrupted()) write_shard(report.folder, result);
  print_batch(report, json, progress);
  return report.interrupted() ? io::kFailed : io::kDone;
}

int sim_batch(const BatchOptions& options) {
  const Shard shard = shard_of(options);
  LaunchConfiguration plan = plan_flight(options.flight);
  const std::uint64_t first_seed = plan.seed;
  if (first_seed > std::numeric_limits<std::uint64_t>::max() - options.runs)
    throw io::InputError("--seed " + std::to_string(first_seed) + ": too large for " +
                         std::to_string(options.runs) + " runs");
  plan.seed += shard.first_run(options.runs);
  const std::size_t runs = shard.run_count(options.runs);
  const std::map<std::string, std::string> inputs = read_inputs(plan);
  const BatchRunner runner(plan, runs);
  require_space(plan.folder, batch_bytes(runs), "--out");
  const RecordFolder folder(plan.folder, existing_record(options.flight), "--out", plan.input_files());
  plan.folder = folder.path();
  io::ProgressLine progress;
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);
  const simulation::World world = draw(plan, plan.seed).world;
  for (const std::string& warning : plant::settings_without_effect(world.simulation, world.vehicle))
    progress.say("warning: " + warning);
  const Interrupts interrupts;

  BatchReport report =
      report_of(plan, options.flight,
                runner.fly(
                    options.jobs, [&] { return interrupts.count() > 0; },
                    [&](const BatchProgress& now) {
                      progress.update(static_cast<int>(kStages * now.done / now.requested), bar(now));
                    }));
  if (options.shard.empty()) return finish_batch(report, options.flight.json, progress);
  report.shard = shard.text();
  return finish_shard({shard, options.runs, first_seed, options.flight.program, inputs, report},
                      options.flight.json, progress);
}

}  // namespace

io::Command add_sim_batch_command(runtime::CommandLine sim, const std::string& version) {
  const auto options = std::make_shared<BatchOptions>();
  FlyOptions& flight = options->flight;
  flight.launch_mode = LaunchMode::kInProcess;
  flight.program = version;
  const runtime::CommandLine app = sim.add_subcommand("batch", io::purpose_of("sim batch"));
  add_mission_options(app, flight);
  add_dispersion_option(app, flight).required();
  app.add_option("--runs", options->runs, "number of runs; the first uses --seed, each further run adds one")
      .range(std::size_t{1}, kMostRuns)
      .show_default();
  app.add_option("--jobs", options->jobs, "number of parallel runs; default: one per core")
      .range(std::size_t{1}, kMostJobs);
  app.add_option(
         "--shard", options->shard,
         "fly only part I of N of the runs, from 1; `swiftlet sim merge` joins the parts, which may be "
         "flown on several computers")
      .type_name("I/N");
  const runtime::Option out =
      app.add_option("--out", flight.record,
                     "new folder for batch.csv, batch.html and batch.png, or for shard.json of a "
                     "shard; default: flights/<date>-<mission>");
  app.add_flag("--replace", flight.replace, "delete the record that the folder of --out holds first")
      .needs(out);
  app.add_flag("--json", flight.json, "print one JSON object instead of the table");
  app.footer(
      "The controller is designed on --vehicle; the flown vehicles are sampled around it. `swiftlet sim fly` "
      "with the seed\nof a run and the same files repeats that run bit for bit.\n\n"
      "example: swiftlet sim batch square --runs 200 --seed 1 --dispersion kaylion --out batches/first");
  return {app, [options] { return sim_batch(*options); }};
}

}  // namespace swiftlet::ground

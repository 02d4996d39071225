#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <thread>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/batch/batch.hpp"
#include "swiftlet/ground/batch/batch_plot.hpp"
#include "swiftlet/ground/batch/batch_report.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/fly_options.hpp"
#include "swiftlet/ground/flight/flight_outcome.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"
#include "swiftlet/ground/terminal/progress_line.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kMostRuns = 1'000'000;
constexpr std::size_t kMostJobs = 1024;
constexpr std::size_t kBarLength = 30;
constexpr std::size_t kStages = 5;  // progress lines in all if standard error is no terminal

// Sizes of the files of a batch, somewhat above those of real ones.
constexpr std::uintmax_t kPictureBytes = 1'000'000;
constexpr std::uintmax_t kRunBytes = 1'500;  // a row of batch.csv and its part of batch.gp

struct BatchOptions {
  FlyOptions flight;
  std::size_t runs = 100;
  std::size_t jobs = std::max(1U, std::thread::hardware_concurrency());
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

// Returns a sentence if a file cannot be written whole.
std::string write_files(const std::filesystem::path& folder, const BatchReport& report, Progress& progress) {
  std::string fault;
  try {
    write_batch_csv(folder / "batch.csv", report);
  } catch (const std::exception& error) {
    fault = error.what();
  }
  try {
    const std::string no_picture = draw_batch(folder, report);
    if (!no_picture.empty()) progress.say(no_picture);
  } catch (const std::exception& error) {
    if (fault.empty()) fault = error.what();
  }
  return fault;
}

int sim_batch(const BatchOptions& options) {
  LaunchConfiguration plan = plan_flight(options.flight);
  if (plan.seed > std::numeric_limits<std::uint64_t>::max() - options.runs)
    throw InputError("--seed " + std::to_string(plan.seed) + ": too large for " +
                     std::to_string(options.runs) + " runs");
  const BatchRunner runner(plan, options.runs);
  require_space(plan.folder, kPictureBytes + kRunBytes * options.runs, "--out");
  const RecordFolder folder(plan.folder, existing_record(options.flight), "--out", plan.input_files());
  plan.folder = folder.path();
  ProgressLine progress;
  for (const std::string& assumption : plan.mission.assumptions)
    progress.say(plan.mission.name + ": " + assumption);
  const Interrupts interrupts;

  const BatchReport report =
      report_of(plan, options.flight,
                runner.fly(
                    options.jobs, [&] { return interrupts.count() > 0; },
                    [&](const BatchProgress& now) {
                      progress.update(static_cast<int>(kStages * now.done / now.requested), bar(now));
                    }));
  const std::string record_fault = write_files(plan.folder, report, progress);

  progress.close();
  std::printf("%s", options.flight.json ? (to_json(report).dump() + "\n").c_str() : to_text(report).c_str());
  if (report.interrupted())
    progress.say(fmt::format("swiftlet: batch cancelled after {} of {} runs", report.batch.runs.size(),
                             report.batch.requested));
  if (!record_fault.empty())
    progress.say("swiftlet: the record " + report.folder + " is incomplete: " + record_fault);
  return report.completed() && record_fault.empty() ? kDone : kFailed;
}

}  // namespace

Command add_sim_batch_command(runtime::CommandLine sim) {
  const auto options = std::make_shared<BatchOptions>();
  FlyOptions& flight = options->flight;
  flight.launch_mode = LaunchMode::kInProcess;
  const runtime::CommandLine app = sim.add_subcommand(
      "batch", "Fly a mission many times, with sampled vehicles and simulations (Monte Carlo)");
  add_mission_options(app, flight);
  add_dispersion_option(app, flight).required();
  app.add_option("--runs", options->runs, "number of runs; the first uses --seed, each further run adds one")
      .range(std::size_t{1}, kMostRuns)
      .show_default();
  app.add_option("--jobs", options->jobs, "number of parallel runs; default: one per core")
      .range(std::size_t{1}, kMostJobs);
  const runtime::Option out = app.add_option(
      "--out", flight.record, "new folder for batch.csv and batch.png; default: flights/<date>-<mission>");
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

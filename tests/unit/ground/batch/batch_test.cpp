#include "swiftlet/ground/batch/batch.hpp"

#include <atomic>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/batch/batch_plot.hpp"
#include "swiftlet/ground/batch/batch_report.hpp"
#include "swiftlet/ground/flight/in_process_flight.hpp"
#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::ground::batch_test {

const std::string kMass =
    "  vehicle.mass: {distribution: uniform, min: 0.95, max: 1.05, unit: nominal, source: estimate}\n";
const std::string kLatency =
    "  simulation.mocap.latency_s: {distribution: uniform, min: 0.005, max: 0.02, unit: s, source: "
    "estimate}\n";
// Some vehicles are so heavy that they take off late and exceed the tolerance.
const std::string kHighMass =
    "  vehicle.mass: {distribution: uniform, min: 0.95, max: 1.8, unit: nominal, source: estimate}\n";
// Most flights lose the pose for 2 s.
const std::string kDropouts =
    "  simulation.mocap.dropout_probability: {distribution: uniform, min: 0.001, max: 0.004, unit: 1, "
    "source: "
    "x}\n"
    "  simulation.mocap.dropout_length_s: {distribution: uniform, min: 1.9, max: 2, unit: s, source: x}\n";

class BatchTest : public testing::Test {
 protected:
  FlyOptions options(const std::string& parameters) const {
    const std::string config = tests::in_source("config/");
    FlyOptions options;
    options.launch_mode = LaunchMode::kInProcess;
    options.mission = folder_.write("hop.yaml", tests::kHopMission);
    options.vehicle = config + "vehicles/kaylion.yaml";
    options.control = config + "control/motor_lag.yaml";
    options.simulation = config + "simulation/default.yaml";
    options.dispersion = folder_.write("vary.yaml", "parameters:\n" + parameters);
    options.record = folder_.path();
    options.seed = 11;
    return options;
  }

  static bool never() { return false; }
  static void ignore_progress(const BatchProgress&) {}

  BatchReport fly(const std::string& parameters, std::size_t runs, std::size_t jobs) const {
    const FlyOptions how = options(parameters);
    const LaunchConfiguration plan = plan_flight(how);
    return report_of(plan, how, BatchRunner(plan, runs).fly(jobs, never, ignore_progress));
  }

  std::string csv(const BatchReport& report) const {
    const auto file = folder_.path() / "batch.csv";
    write_batch_csv(file, report);
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  // The flight of `sim fly` with the seed of a run.
  analysis::FlightReport repeated(const std::string& parameters, std::uint64_t seed) const {
    FlyOptions how = options(parameters);
    how.seed = seed;
    const LaunchConfiguration plan = plan_flight(how);
    simulation::ClosedLoop loop = closed_loop(plan, draw(plan, plan.seed).world, plan.seed);
    record::Flight flight;
    return fly_in_process(loop, plan, plan.seed, flight, nullptr, never);
  }

  void expect_failures_to_repeat(const std::string& parameters, const BatchReport& report) const {
    ASSERT_GT(report.batch.failed(), 0U);
    EXPECT_FALSE(report.completed());
    for (const BatchRun& run : report.batch.runs) {
      if (run.completed) continue;
      const analysis::FlightReport again = repeated(parameters, run.seed);
      EXPECT_FALSE(again.completed);
      EXPECT_EQ(again.reason, run.reason);
      EXPECT_EQ(again.errors.rms_3d_m, run.rms_3d_m);
      EXPECT_EQ(again.errors.peak_3d_m, run.peak_3d_m);
      EXPECT_EQ(again.duration_s, run.duration_s);
    }
  }

  tests::TemporaryFolder folder_;
};

TEST_F(BatchTest, TableIsIndependentOfTheNumberOfJobs) {
  const BatchReport one = fly(kMass + kLatency, 8, 1);
  EXPECT_TRUE(one.completed());
  EXPECT_EQ(csv(one), csv(fly(kMass + kLatency, 8, 4)));
}

TEST_F(BatchTest, TableIsIndependentOfTheOrderOfKeys) {
  EXPECT_EQ(csv(fly(kMass + kLatency, 3, 2)), csv(fly(kLatency + kMass, 3, 2)));
}

TEST_F(BatchTest, FliesEachRunWithItsOwnSeedAndSample) {
  const BatchReport report = fly(kMass + kLatency, 4, 2);
  ASSERT_EQ(report.batch.runs.size(), 4U);
  EXPECT_EQ(report.parameters, (std::vector<std::string>{"vehicle.mass", "simulation.mocap.latency_s"}));
  for (std::size_t i = 0; i < 4; ++i) {
    const BatchRun& run = report.batch.runs[i];
    EXPECT_EQ(run.seed, 11 + i);
    EXPECT_TRUE(run.completed) << run.reason;
    EXPECT_GT(run.rms_3d_m, 0.0);
    EXPECT_LT(run.rms_3d_m, 0.05);
    EXPECT_GT(run.duration_s, 5.0);
    const analysis::FlightReport again = repeated(kMass + kLatency, run.seed);
    EXPECT_EQ(again.errors.rms_3d_m, run.rms_3d_m);
    EXPECT_EQ(again.errors.peak_3d_m, run.peak_3d_m);
  }
  EXPECT_NE(report.batch.runs[0].values, report.batch.runs[1].values);
}

TEST_F(BatchTest, FirstRunsAreIndependentOfTheNumberOfRuns) {
  const std::string shorter = csv(fly(kMass, 2, 2));
  EXPECT_EQ(csv(fly(kMass, 4, 2)).substr(0, shorter.size()), shorter);
}

TEST_F(BatchTest, FailuresFromAHighMassRepeat) {
  const BatchReport report = fly(kHighMass, 6, 2);
  EXPECT_LT(report.batch.failed(), 6U) << "expected some runs to complete";
  expect_failures_to_repeat(kHighMass, report);
}

TEST_F(BatchTest, FailuresFromPoseDropoutsRepeat) {
  const BatchReport report = fly(kDropouts, 4, 2);
  expect_failures_to_repeat(kDropouts, report);
}

TEST_F(BatchTest, FliesTheNominalVehicleWithoutDispersion) {
  FlyOptions how = options(kMass);
  how.dispersion.clear();
  const LaunchConfiguration plan = plan_flight(how);
  const simulation::World world = draw(plan, plan.seed).world;
  EXPECT_EQ(world.vehicle.mass_kg, plan.vehicle.mass_kg);
  EXPECT_EQ(world.vehicle.motor.armature_resistance_ohm, plan.vehicle.motor.armature_resistance_ohm);
}

TEST_F(BatchTest, CancelKeepsTheCompletedRuns) {
  const FlyOptions how = options(kMass);
  const LaunchConfiguration plan = plan_flight(how);
  std::atomic<bool> cancelled{false};
  Batch batch = BatchRunner(plan, 500).fly(
      2, [&] { return cancelled.load(); }, [&](const BatchProgress& now) { cancelled = now.done >= 1; });
  const BatchReport report = report_of(plan, how, std::move(batch));
  EXPECT_TRUE(report.interrupted());
  EXPECT_FALSE(report.completed());
  EXPECT_GE(report.batch.runs.size(), 1U);
  EXPECT_LT(report.batch.runs.size(), 500U);
  EXPECT_EQ(report.batch.failed(), 0U) << "cancelled runs do not count as failed";
  EXPECT_NE(to_text(report).find("NOT flown: batch cancelled"), std::string::npos);
  EXPECT_EQ(to_json(report).at("interrupted"), true);
}

TEST_F(BatchTest, RefusesTooManyJobs) {
  const BatchRunner runner(plan_flight(options(kMass)), 2);
  EXPECT_THROW(runner.fly(0, never, ignore_progress), std::invalid_argument);
  EXPECT_THROW(runner.fly(kMostJobs + 1, never, ignore_progress), std::invalid_argument);
}

TEST_F(BatchTest, SamplesAllVehiclesBeforeTheFirstFlight) {
  const LaunchConfiguration plan = plan_flight(
      options("  vehicle.inertia.zz: {distribution: uniform, min: 1.5, max: 2, unit: nominal, source: x}\n"));
  EXPECT_THROW(BatchRunner(plan, 3), io::ConfigError);
}

// Two runs without flights, the second one failed.
BatchReport example_report(const LaunchConfiguration& plan, const FlyOptions& how) {
  Batch batch;
  batch.requested = 2;
  BatchRun good;
  good.seed = 11;
  good.completed = true;
  good.rms_3d_m = 0.001;
  good.peak_3d_m = 0.005;
  good.margins_deg = {60, 61, 62, 31, 32, 47};
  good.values = {0.04};
  BatchRun bad = good;
  bad.seed = 12;
  bad.completed = false;
  bad.reason = "it went away, \"far\"";
  bad.rms_3d_m = bad.peak_3d_m = std::nan("");
  bad.values = {0.06};
  batch.runs = {good, bad};
  return report_of(plan, how, std::move(batch));
}

TEST_F(BatchTest, ReportsTheCommandThatRepeatsAFailedRun) {
  FlyOptions how = options(kMass);
  const LaunchConfiguration plan = plan_flight(how);
  how.mission = "hop";
  how.vehicle = "it's mine.yaml";
  how.control = "motor_lag";
  how.simulation = "default";
  how.dispersion = "vary/room.yaml";
  how.imu_rate_hz = 1000;
  const BatchReport report = example_report(plan, how);
  const std::string command =
      "swiftlet sim fly hop --vehicle 'it'\\''s mine.yaml' --imu-rate 1000 --dispersion vary/room.yaml "
      "--seed 12";
  EXPECT_EQ(report.repeat_command(12), command);
  EXPECT_NE(to_text(report).find("  seed 12: it went away, \"far\": " + command + "\n"), std::string::npos);
}

TEST_F(BatchTest, JsonHasNullForMissingFigures) {
  const FlyOptions how = options(kMass);
  const nlohmann::json json = nlohmann::json::parse(to_json(example_report(plan_flight(how), how)).dump());
  EXPECT_EQ(json.at("completed"), false);
  EXPECT_EQ(json.at("interrupted"), false);
  EXPECT_EQ(json.at("runs"), 2);
  EXPECT_EQ(json.at("runs_failed"), 1);
  EXPECT_EQ(json.at("rms_3d_m").at("n"), 1);
  EXPECT_EQ(json.at("rms_3d_m").at("median"), 0.001);
  EXPECT_EQ(json.at("phase_margin_deg").at("x").at("min"), 31.0);
  EXPECT_TRUE(json.at("rank_correlation_with_rms").at("vehicle.mass").at("value").is_null());
  ASSERT_EQ(json.at("failures").size(), 1U);
  EXPECT_EQ(json.at("failures")[0].at("seed"), 12);
  EXPECT_EQ(json.at("failures")[0].at("reason"), "it went away, \"far\"");
}

// An error that grows to both sides of the median depends on the distance from it, not on the value.
TEST_F(BatchTest, EffectsIncludeTheDistanceFromTheMedian) {
  const FlyOptions how = options(kMass);
  Batch batch;
  batch.requested = 5;
  for (const double value : {1.0, 2.0, 3.0, 4.0, 5.0}) {
    BatchRun run;
    run.completed = true;
    run.rms_3d_m = std::abs(value - 3.0);
    run.values = {value};
    batch.runs.push_back(run);
  }
  const BatchReport report = report_of(plan_flight(how), how, batch);
  ASSERT_EQ(report.effects.size(), 1U);
  EXPECT_NEAR(report.effects[0].of_value, 0.0, 1e-12);
  EXPECT_NEAR(report.effects[0].of_distance, 1.0, 1e-12);
}

TEST_F(BatchTest, CsvHasARowForEachRun) {
  const FlyOptions how = options(kMass);
  const std::string text = csv(example_report(plan_flight(how), how));
  EXPECT_EQ(text,
            "seed,completed,reason,rms_3d_m,peak_3d_m,duration_s,margin_roll_deg,margin_pitch_deg,"
            "margin_yaw_deg,margin_x_deg,margin_y_deg,margin_z_deg,vehicle.mass\n"
            "11,1,\"\",0.001,0.005,0,60,61,62,31,32,47,0.04\n"
            "12,0,\"it went away, \"\"far\"\"\",,,0,60,61,62,31,32,47,0.06\n");
}

TEST_F(BatchTest, DrawsAPicture) {
  ASSERT_FALSE(io::find_program("gnuplot").empty()) << "install the packages of packages.txt";
  BatchReport report = fly(kMass + kLatency, 4, 2);
  report.mission = "it's_a 'hop'";
  csv(report);
  EXPECT_EQ(draw_batch(folder_.path(), report), "");
  EXPECT_GT(std::filesystem::file_size(folder_.path() / "batch.png"), 20'000U);
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "batch.gp")) << "kept to draw the picture again";
}

TEST_F(BatchTest, ReportsWhyNoPictureIsDrawn) {
  EXPECT_EQ(draw_batch(folder_.path(), {}), "no picture was drawn: no run has a tracking error");
}

}  // namespace swiftlet::ground::batch_test

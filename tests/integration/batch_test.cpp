// `swiftlet sim batch` from end to end.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/eventually.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

const std::string kMass =
    "parameters:\n"
    "  vehicle.mass: {distribution: uniform, min: 0.95, max: 1.05, unit: nominal, source: estimate}\n";
const std::string kHighMass =
    "parameters:\n"
    "  vehicle.mass: {distribution: uniform, min: 0.95, max: 1.8, unit: nominal, source: estimate}\n";

class SimBatch : public testing::Test {
 protected:
  std::vector<std::string> words(const std::string& command, const std::string& dispersion,
                                 const std::vector<std::string>& more) const {
    std::vector<std::string> all = {"sim", command, folder_.write("hop.yaml", kHopMission), "--dispersion",
                                    folder_.write("vary.yaml", dispersion)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  ProgramResult batch(const std::string& dispersion, std::vector<std::string> more) const {
    more.insert(more.end(), {"--out", out().string()});
    return run_program("swiftlet", words("batch", dispersion, more), folder_.path());
  }
  fs::path out() const { return folder_.path() / "out"; }

  TemporaryFolder folder_;
};

TEST_F(SimBatch, WritesFilesAndReportsFigures) {
  const ProgramResult result = batch(kMass, {"--runs", "4", "--seed", "3"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("4 completed, 0 failed"), std::string::npos) << result.output;
  EXPECT_NE(result.output.find("tracking error, RMS"), std::string::npos);
  EXPECT_NE(result.output.find("vehicle.mass"), std::string::npos);
  EXPECT_NE(result.errors.find("4/4 runs, 0 failed"), std::string::npos) << "no progress: " << result.errors;
  EXPECT_TRUE(fs::exists(out() / "batch.csv"));
  EXPECT_GT(fs::file_size(out() / "batch.png"), 20'000U);
  EXPECT_NE(contents(out() / "batch.html").find("<figcaption>phase margin (deg)</figcaption>"),
            std::string::npos);
}

TEST_F(SimBatch, RepeatsAFailedRunExactly) {
  const ProgramResult result = batch(kHighMass, {"--runs", "6", "--seed", "11", "--json"});
  EXPECT_EQ(result.exit_code, 1) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), false);
  EXPECT_GT(report.at("runs_failed"), 0);
  EXPECT_LT(report.at("runs_failed"), 6);
  const json& failure = report.at("failures").at(0);
  const std::string seed = std::to_string(failure.at("seed").get<int>());
  EXPECT_NE(failure.at("repeat").get<std::string>().find(" --seed " + seed), std::string::npos);

  const ProgramResult again = run_program(
      "swiftlet",
      words("fly", kHighMass, {"--seed", seed, "--json", "--record", (folder_.path() / "record").string()}),
      folder_.path());
  EXPECT_EQ(again.exit_code, 1) << again.errors;
  const json flight = json::parse(again.output);
  EXPECT_EQ(flight.at("reason"), failure.at("reason"));
  EXPECT_EQ(flight.at("dispersion"), "vary");
  std::ifstream csv(out() / "batch.csv");
  const std::string table{std::istreambuf_iterator<char>(csv), {}};
  const std::string figures = "," + flight.at("rms_3d_m").dump() + "," + flight.at("peak_3d_m").dump() + ",";
  EXPECT_NE(table.find("\n" + seed + ",0,"), std::string::npos) << table;
  EXPECT_NE(table.find(figures), std::string::npos) << figures << " is not in\n" << table;
}

// Some of the runs fail, and some parameters are sampled again, so that all that is merged is in the result.
TEST_F(SimBatch, MergedShardsAreTheBatchByteForByte) {
  const std::vector<std::string> seven = {"--runs", "7", "--seed", "11", "--json"};
  const ProgramResult whole = batch(kHighMass, seven);
  ASSERT_EQ(whole.exit_code, 1) << whole.errors;
  std::vector<std::string> merge = {"sim", "merge", "--json", "--out", (folder_.path() / "merged").string()};
  for (const char* shard : {"3", "1", "2"}) {
    const std::string part = (folder_.path() / shard).string();
    std::vector<std::string> more = seven;
    more.insert(more.end(), {"--shard", std::string(shard) + "/3", "--out", part});
    const ProgramResult flown = run_program("swiftlet", words("batch", kHighMass, more), folder_.path());
    EXPECT_EQ(flown.exit_code, 0) << "a failed run is no failure of a shard: " << flown.errors;
    EXPECT_EQ(json::parse(flown.output).at("shard"), std::string(shard) + "/3");
    EXPECT_FALSE(fs::exists(fs::path(part) / "batch.csv"));
    merge.push_back(part);
  }
  const ProgramResult merged = run_program("swiftlet", merge, folder_.path());
  EXPECT_EQ(merged.exit_code, 1) << merged.errors;
  EXPECT_EQ(contents(folder_.path() / "merged" / "batch.csv"), contents(out() / "batch.csv"));
  EXPECT_EQ(contents(folder_.path() / "merged" / "batch.png"), contents(out() / "batch.png"));
  EXPECT_EQ(contents(folder_.path() / "merged" / "batch.html"), contents(out() / "batch.html"));
  const auto without_time = [](const std::string& text) {
    json report = json::parse(text);
    for (const char* of_this_run : {"wall_s", "out_dir"}) EXPECT_EQ(report.erase(of_this_run), 1U);
    return report.dump();
  };
  EXPECT_EQ(without_time(merged.output), without_time(whole.output));

  merge.pop_back();
  merge[4] = (folder_.path() / "incomplete").string();
  const ProgramResult incomplete = run_program("swiftlet", merge, folder_.path());
  EXPECT_EQ(incomplete.exit_code, 2);
  EXPECT_NE(incomplete.errors.find("shard 2/3 is missing: 2 of 3 are given"), std::string::npos)
      << incomplete.errors;
  EXPECT_FALSE(fs::exists(merge[4]));
}

TEST_F(SimBatch, ACancelledShardLeavesNothingBehind) {
  Program program("swiftlet",
                  words("batch", kMass, {"--runs", "40000", "--shard", "1/2", "--out", out().string()}),
                  folder_.path());
  ASSERT_TRUE(eventually([&] { return program.errors().find("/20000 runs") != std::string::npos; }, kStuck));
  program.signal(SIGTERM);
  EXPECT_EQ(program.wait(kStuck), 1) << program.errors();
  EXPECT_FALSE(fs::exists(out())) << "a scheduler starts the shard again with the same --out";
}

TEST_F(SimBatch, ReportsCompletedRunsWhenCancelled) {
  Program program("swiftlet", words("batch", kMass, {"--runs", "20000", "--json", "--out", out().string()}),
                  folder_.path());
  ASSERT_TRUE(eventually([&] { return program.errors().find("/20000 runs") != std::string::npos; }, kStuck));
  program.signal(SIGINT);
  EXPECT_EQ(program.wait(kStuck), 1) << program.errors();
  const json report = json::parse(program.output());
  EXPECT_EQ(report.at("interrupted"), true);
  EXPECT_LT(report.at("runs_done"), 20000);
  EXPECT_NE(program.errors().find("batch cancelled after"), std::string::npos) << program.errors();
}

TEST_F(SimBatch, RefusesBadInputBeforeItCreatesAFolder) {
  const auto expect_refusal = [&](const std::string& dispersion, const std::vector<std::string>& more,
                                  const std::string& sentence) {
    const ProgramResult result = batch(dispersion, more);
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_FALSE(fs::exists(out()));
  };
  expect_refusal("parameters: {}\n", {}, "vary.yaml:1: parameters: is empty");
  expect_refusal(kMass, {"--runs", "0"}, "--runs");
  expect_refusal(kMass, {"--jobs", "0"}, "--jobs");
  expect_refusal(kMass, {"--seed", "-1"}, "--seed");
  expect_refusal(kMass, {"--seed", "18446744073709551615", "--runs", "2"}, "--seed");
  expect_refusal(kMass, {"--shard", "2"}, "shard '2': must be I/N");
  expect_refusal(kMass, {"--shard", "0/4"}, "shard '0/4': the shard must be from 1 to 4");
  expect_refusal(kMass, {"--shard", "5/4"}, "shard '5/4': the shard must be from 1 to 4");
  expect_refusal(kMass, {"--shard", "1/0"}, "shard '1/0': the number of shards must be from 1 to 100000");
  expect_refusal(kMass, {"--runs", "3", "--shard", "1/4"}, "3 runs cannot be shared by 4 shards");
  expect_refusal(kMass, {"--vehicle", "nobody"}, "No vehicle 'nobody'. Available: crazyflie2, kaylion");
  const ProgramResult without_dispersion =
      run_program("swiftlet", {"sim", "batch", "square"}, folder_.path());
  EXPECT_EQ(without_dispersion.exit_code, 2);
  EXPECT_NE(without_dispersion.errors.find("--dispersion"), std::string::npos) << without_dispersion.errors;
}

}  // namespace
}  // namespace swiftlet::tests

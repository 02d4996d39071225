// `swiftlet fly` from end to end: real processes, real network.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/campaign.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/plant_log.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

// Long enough to disturb it in flight.
const std::string kLongMission =
    "name: hover\n"
    "frame: ned\n"
    "tolerance_m: 0.1\n"
    "items:\n"
    "  - {kind: takeoff, height_m: 1.2, speed_m_s: 0.8}\n"
    "  - {kind: waypoint, position_m: [0, 0, -1.3], speed_m_s: 0.5, hold_s: 500}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";

class Fly : public testing::Test {
 protected:
  std::vector<std::string> arguments(const std::string& mission, std::vector<std::string> more = {}) const {
    std::vector<std::string> words = {"fly", mission, "--json", "--record", record().string(), "--replace"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  fs::path record() const { return folder_.path() / "record"; }

  // All output, for failure messages.
  std::string all_output(const Program& fly) const {
    std::string text = fly.output() + fly.errors();
    for (const char* process : {"swiftlet-plant", "swiftlet-mocap", "swiftlet-control"}) {
      std::ifstream log(record() / (std::string(process) + ".log"));
      text += std::string("\n--- ") + process + "\n" + std::string(std::istreambuf_iterator<char>(log), {});
    }
    return text;
  }

  TemporaryFolder folder_;
};

// Expects one control step per IMU sample of the flight, by the vehicle's clock. A machine that stalls slows
// both down, so the rate in real time may be lower but not higher.
void expect_control_rate(const json& report, double rate_hz) {
  const double cycles = report.at("cycles");
  EXPECT_GT(cycles, 0.95 * rate_hz * report.at("duration_s").get<double>());
  EXPECT_LT(cycles, 1.05 * rate_hz * report.at("simulated_s").get<double>());
  EXPECT_GT(report.at("control_rate_hz"), 0.0);
  EXPECT_LT(report.at("control_rate_hz"), 1.05 * rate_hz);
}

// Waits for the wall clock: real time is kept, and latencies are measured by it.
TEST_F(Fly, FliesReportsAndRecordsAMissionInRealTime) {
  Program fly("swiftlet", arguments(folder_.write("hop.yaml", kHopMission), {"--seed", "7"}), folder_.path());
  ASSERT_EQ(fly.wait(kStuck), 0) << all_output(fly);

  const json report = json::parse(fly.output());
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_FALSE(report.contains("reason"));
  EXPECT_EQ(report.at("mission"), "hop");
  EXPECT_EQ(report.at("seed"), 7);
  EXPECT_EQ(report.at("record_dir"), record().string());
  EXPECT_GT(report.at("duration_s"), 5.0);
  EXPECT_LT(report.at("duration_s"), 15.0);
  EXPECT_GT(report.at("rms_3d_m"), 0.0);
  EXPECT_LT(report.at("rms_3d_m"), 0.010);
  EXPECT_LT(report.at("peak_3d_m"), 0.1);
  EXPECT_GT(report.at("matched_samples"), 200);
  expect_control_rate(report, 500.0);
  const json& latency = report.at("sense_to_actuate_us");
  EXPECT_GT(latency.at("p50"), 0.0);
  EXPECT_LE(latency.at("p50"), latency.at("p99"));
  EXPECT_LE(latency.at("p99"), latency.at("max"));

  std::ifstream report_file(record() / "report.json");
  EXPECT_EQ(json::parse(report_file), report);
  EXPECT_LT(fs::file_size(record() / "flight.mcap"), 3'000'000U);
  EXPECT_GT(fs::file_size(record() / "flight.png"), 20'000U);
  EXPECT_NE(fly.errors().find("2/3 waypoint"), std::string::npos) << "no progress shown: " << fly.errors();
}

// Three times as fast as the wall clock, and with it the rate of control.
TEST_F(Fly, SpeedScalesRealTime) {
  constexpr double kSpeed = 3.0;
  Program fly("swiftlet", arguments(folder_.write("hop.yaml", kHopMission), {"--speed", "3"}),
              folder_.path());
  ASSERT_EQ(fly.wait(kStuck), 0) << all_output(fly);
  const json report = json::parse(fly.output());
  const double rate_hz = report.at("control_rate_hz");
  EXPECT_LT(rate_hz, kSpeed * 550.0);
  // The plant says for how long it did not run: time stood still meanwhile.
  const double measured_s = report.at("cycles").get<double>() / rate_hz;
  EXPECT_GT(rate_hz * measured_s / (measured_s - 1e-3 * behind_real_time_ms(all_output(fly))), kSpeed * 450.0)
      << all_output(fly);
  EXPECT_LT(report.at("rms_3d_m"), 0.010);
}

TEST_F(Fly, FailsBeyondTheMissionsTolerance) {
  std::string mission = kHopMission;
  mission.replace(mission.find("0.1"), 3, "1e-6");
  Program fly("swiftlet", arguments(folder_.write("strict.yaml", mission), {"--clock", "lockstep"}),
              folder_.path());
  ASSERT_EQ(fly.wait(kStuck), 1) << all_output(fly);
  const json report = json::parse(fly.output());
  EXPECT_EQ(report.at("completed"), false);
  EXPECT_NE(report.at("reason").get<std::string>().find("the tolerance is 0.000 m"), std::string::npos)
      << report;
}

TEST_F(Fly, TwoAtOnceDoNotInterfere) {
  const std::string mission = folder_.write("hop.yaml", kHopMission);
  const auto words = [&](const char* name) {
    return std::vector<std::string>{
        "fly", mission, "--json", "--clock", "lockstep", "--record", folder_.path() / name};
  };
  Program first("swiftlet", words("a"), folder_.path());
  Program second("swiftlet", words("b"), folder_.path());
  EXPECT_EQ(first.wait(kStuck), 0) << first.errors();
  EXPECT_EQ(second.wait(kStuck), 0) << second.errors();
}

// A limit of the file's size stands for the disk. The flight goes on to its landing, and is judged by what was recorded.
TEST_F(Fly, ADiskThatFillsEndsTheRecordAndNotTheFlight) {
  std::vector<std::string> words = {
      "--fsize=600000", program_file("swiftlet"), "fly", "square", "--clock", "lockstep",
      "--record",       record().string()};
  const ProgramResult flight = run_program("/usr/bin/prlimit", words, folder_.path(), kStuck);
  EXPECT_EQ(flight.exit_code, 1);
  EXPECT_NE(flight.output.find("square: completed"), std::string::npos) << flight.output << flight.errors;
  EXPECT_NE(flight.output.find("takeoff to the end of the record"), std::string::npos) << flight.output;
  EXPECT_NE(flight.errors.find("is incomplete: "), std::string::npos) << flight.errors;
  EXPECT_NE(flight.errors.find("cannot be written: File too large"), std::string::npos) << flight.errors;
  const ProgramResult page = run_program("swiftlet", {"report", record().string()}, folder_.path());
  EXPECT_EQ(page.exit_code, 0) << page.errors;
}

// A flight in lockstep that is interrupted once it is airborne.
class FlyInterrupted : public Fly {
 protected:
  void start(std::vector<std::string> more = {}, const std::string& clock = "lockstep") {
    more.insert(more.end(), {"--clock", clock});
    fly_.emplace("swiftlet", arguments(folder_.write("hover.yaml", kLongMission), more), folder_.path());
    ASSERT_TRUE(eventually([&] { return fly_->errors().find("2/3 waypoint") != std::string::npos; }))
        << all_output(*fly_);
    children_ = children_of(fly_->pid());
    ASSERT_EQ(children_.size(), 3U);
  }

  void expect_end_without_leftovers() {
    for (const pid_t child : children_)
      EXPECT_TRUE(eventually([&] { return !is_running(child); })) << child << " still runs";
  }

  std::optional<Program> fly_;
  std::vector<pid_t> children_;
};

class FlyWithADeadProcess : public FlyInterrupted, public testing::WithParamInterface<std::string> {};

TEST_P(FlyWithADeadProcess, NamesTheProcessThatDied) {
  const std::string name = "swiftlet-" + GetParam();
  start();
  const pid_t victim = child_of(fly_->pid(), name);
  ASSERT_GT(victim, 0);
  ASSERT_EQ(kill(victim, SIGKILL), 0);
  ASSERT_EQ(fly_->wait(kStuck), 1) << all_output(*fly_);
  const json report = json::parse(fly_->output());
  EXPECT_EQ(report.at("completed"), false);
  EXPECT_EQ(report.at("reason").get<std::string>().find(name + " was killed by signal 9 (Killed)"), 0U)
      << report;
  EXPECT_NE(fly_->errors().find(name), std::string::npos);
  EXPECT_GT(fs::file_size(record() / "flight.mcap"), 10'000U) << "the record so far must be kept";
  expect_end_without_leftovers();
}

// The vehicle lands before the processes end: PX4, say, is told to by its bridge.
TEST_P(FlyWithADeadProcess, LandsFirstInRealTime) {
  const std::string name = "swiftlet-" + GetParam();
  start({"--speed", "0.5"}, "realtime");  // beside other tests
  ASSERT_EQ(kill(child_of(fly_->pid(), name), SIGKILL), 0);
  ASSERT_EQ(fly_->wait(kStuck), 1) << all_output(*fly_);
  const std::map<std::string, std::string> ends = {
      {"plant", "; while landing, the vehicle has sent nothing for 1 s"},
      {"mocap", "; landed"},
      {"control", "; the vehicle has stopped its rotors"}};
  const auto reason = json::parse(fly_->output()).at("reason").get<std::string>();
  EXPECT_EQ(reason.find(name + " was killed by signal 9 (Killed)"), 0U) << reason;
  const std::string& end = ends.at(GetParam());
  EXPECT_EQ(reason.substr(reason.size() - std::min(end.size(), reason.size())), end) << reason;
  expect_end_without_leftovers();
}

INSTANTIATE_TEST_SUITE_P(, FlyWithADeadProcess, testing::Values("plant", "mocap", "control"),
                         [](const auto& run) { return run.param; });

TEST_F(FlyInterrupted, LandsOnTheFirstInterrupt) {
  start();
  fly_->signal(SIGINT);
  ASSERT_EQ(fly_->wait(kStuck), 1) << all_output(*fly_);
  const json report = json::parse(fly_->output());
  EXPECT_EQ(report.at("completed"), false);
  EXPECT_EQ(report.at("reason"), "interrupted; landed");
  expect_end_without_leftovers();
}

// The landing takes long enough to be interrupted.
TEST_F(FlyInterrupted, QuitsOnTheSecondInterrupt) {
  start({"--speed", "2"});
  fly_->signal(SIGINT);
  ASSERT_TRUE(eventually(
      [&] { return fly_->errors().find("interrupt again to quit at once") != std::string::npos; }));
  const auto second = std::chrono::steady_clock::now();
  fly_->signal(SIGINT);
  ASSERT_EQ(fly_->wait(kStuck), 1) << all_output(*fly_);
  EXPECT_EQ(json::parse(fly_->output()).at("reason"), "interrupted; quit in flight");
  EXPECT_LT(std::chrono::steady_clock::now() - second, 10s);
  expect_end_without_leftovers();
}

TEST_F(FlyInterrupted, EndsItsProcessesWhenKilled) {
  start();
  fly_->signal(SIGKILL);
  ASSERT_EQ(fly_->wait(kStuck), 128 + SIGKILL);
  expect_end_without_leftovers();
}

// The whole paths of the paper's Figs. 8 and 9: one in lockstep, the others in one process, which flies the same (lockstep_test.cpp);
// `./dev soak flights` flies them in real time.
struct PaperFlight {
  const char* name;
  const char* mission;
  const char* control;
  bool over_dds;
  double rms_limit_m;
};
void PrintTo(const PaperFlight& flight, std::ostream* out) { *out << flight.name; }

class FlyPaper : public Fly, public testing::WithParamInterface<PaperFlight> {};

TEST_P(FlyPaper, TracksItsPath) {
  const PaperFlight& flight = GetParam();
  std::vector<std::string> words = arguments(flight.mission, {"--control", flight.control});
  if (!is_soak() && flight.over_dds) words.insert(words.end(), {"--clock", "lockstep"});
  if (!is_soak() && !flight.over_dds) words.insert(words.begin(), "sim");
  Program fly("swiftlet", words, folder_.path());
  ASSERT_EQ(fly.wait(kStuck), 0) << all_output(fly);
  const json report = json::parse(fly.output());
  EXPECT_EQ(report.at("completed"), true) << report;
  EXPECT_NEAR(report.at("duration_s"), 40.0, 4.0);
  EXPECT_LE(report.at("rms_3d_m"), flight.rms_limit_m) << report;
  EXPECT_GT(report.at("matched_samples"), 2500);
  RecordProperty("rms_3d_m", std::to_string(report.at("rms_3d_m").get<double>()));
}

INSTANTIATE_TEST_SUITE_P(, FlyPaper,
                         testing::Values(PaperFlight{"Square", "square", "motor_lag", true, 0.010},
                                         PaperFlight{"ZigZag", "zigzag", "motor_lag", false, 0.010},
                                         PaperFlight{"SquareWithThePapersLoops", "square", "paper", false,
                                                     0.030}),
                         [](const auto& flight) { return std::string(flight.param.name); });

}  // namespace
}  // namespace swiftlet::tests

// The online commands with running processes.
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/online_flight.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;

TEST_F(OnlineFlight, ExecutesEveryCommand) {
  expect_refused({"takeoff"}, "not armed; run `swiftlet arm` first");
  expect_refused({"hold"}, "on the ground; take off first");
  expect_accepted({"arm"});
  ASSERT_TRUE(reaches_mode("armed"));
  expect_refused({"takeoff", "0.01"}, "height 0.01 m is too low; minimum is 0.10 m");
  expect_accepted({"stop", "--yes"});
  ASSERT_TRUE(reaches_mode("stopped"));
  expect_refused({"arm"}, "emergency stop is active; run `swiftlet disarm` first");
  expect_accepted({"disarm"});
  ASSERT_TRUE(reaches_mode("disarmed"));
  take_off();
  expect_refused({"takeoff"}, "already airborne; use goto");
  expect_refused({"disarm"}, "cannot disarm while holding; land first, or run `swiftlet stop`");
  expect_refused({"goto", "-1", "9", "-1"}, "y is 9.000 m, outside the fence of -3.000 to 3.000 m");
  expect_refused({"goto", "1", "0", "0"},
                 "z = 0.000 m is 0.000 m above the ground; the minimum height is 0.100 m, z = -0.100 m");
  expect_accepted({"goto", "0", "0", "--height", "0.5"});
  ASSERT_TRUE(reaches_place(0.0, 0.0, -0.5));
  expect_accepted({"goto", "-0.4", "0.3", "-0.8", "--yaw", "0.5", "--speed", "0.8"});
  ASSERT_TRUE(reaches_place(-0.4, 0.3, -0.8));
  expect_accepted({"hold"});
  expect_accepted({"land"});
  ASSERT_TRUE(reaches_mode("disarmed"));
  EXPECT_EQ(status().at("request"),
            json({{"kind", "land"}, {"state", "succeeded"}, {"progress", 1.0}, {"result", ""}}));
  ASSERT_TRUE(reaches_place(-0.4, 0.3, 0.0));
}

TEST_F(OnlineFlight, WaitOptionWaitsForTheResult) {
  const auto done = [this](std::vector<std::string> words) {
    const std::string what = words.front();
    words.insert(words.end(), {"--wait", "60"});
    const ProgramResult result = swiftlet(words, kStuck);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, what + ": accepted by kl7\n" + what + ": done\n");
  };
  done({"arm"});
  done({"takeoff", "0.6"});
  EXPECT_EQ(status().at("mode"), "holding");
  done({"goto", "0.4", "0", "-0.6", "--speed", "0.8"});
  EXPECT_NEAR(status().at("position_ned_m")[0].get<double>(), 0.4, 0.05);
  const ProgramResult timed_out =
      swiftlet({"goto", "-0.5", "0", "-0.6", "--speed", "0.3", "--wait", "0.3", "--json"});
  EXPECT_EQ(timed_out.exit_code, 1);
  EXPECT_EQ(json::parse(timed_out.output),
            json({{"accepted", true}, {"done", false}, {"reason", "not done after 0.3 s"}}));
  done({"hold"});
  done({"land"});
  EXPECT_EQ(status().at("mode"), "disarmed");
}

// The line of README.md, or else of docs, as a reader copies it.
std::string documented_chain() {
  namespace fs = std::filesystem;
  std::vector<fs::path> files = {fs::path(SWIFTLET_SOURCE_DIR) / "README.md"};
  for (const auto& entry : fs::recursive_directory_iterator(SWIFTLET_SOURCE_DIR "/docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  }
  for (const fs::path& file : files) {
    std::ifstream text(file);
    for (std::string line; std::getline(text, line);) {
      if (line.rfind("swiftlet arm && swiftlet takeoff 1 && swiftlet goto 1 0 -1 && swiftlet land", 0) == 0)
        return line;
    }
  }
  return "";
}

TEST_F(OnlineFlight, DocumentedChainOfCommandsFlies) {
  const std::string chain = documented_chain();
  ASSERT_NE(chain, "");
  std::string options;
  for (const std::string& word : network()) options += " " + word;
  const std::string script = folder_.write(
      "chain.bash", "swiftlet() { '" SWIFTLET_BIN_DIR "/swiftlet' \"$@\"" + options + "; }\n" + chain + "\n");
  const ProgramResult result = run_program("/bin/bash", {"--norc", script}, folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* line : {"arm: done\n", "takeoff: done\n", "goto: done\n", "land: done\n"})
    EXPECT_NE(result.output.find(line), std::string::npos) << line << result.output;
  const json now = status();
  EXPECT_EQ(now.at("mode"), "disarmed");
  EXPECT_NEAR(now.at("position_ned_m")[0].get<double>(), 1.0, 0.1);
}

// GIVEN a command that waits WHEN it is interrupted THEN the vehicle does not go on.
TEST_F(OnlineFlight, InterruptedTakeOffHoldsOrDisarms) {
  expect_accepted({"arm"});
  std::vector<std::string> words = {"takeoff", "2", "--speed", "0.2"};
  for (const std::string& word : network()) words.push_back(word);
  Program takeoff("swiftlet", words, folder_.path());
  ASSERT_TRUE(eventually([&] { return takeoff.output() == "takeoff: accepted by kl7\n"; }, kStuck));
  takeoff.signal(SIGTERM);
  EXPECT_EQ(takeoff.wait(kStuck), 1);
  const std::string mode = status().at("mode");
  const std::string now = mode == "disarmed" ? "kl7 is disarmed" : "kl7 holds";
  EXPECT_TRUE(mode == "disarmed" || mode == "holding") << mode;
  EXPECT_EQ(takeoff.errors(), "swiftlet: takeoff: interrupted; " + now + "\n");
}

TEST_F(OnlineFlight, InterruptedMissionIsPaused) {
  const std::string file = folder_.write("walk.yaml",
                                         "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                                         "  - {kind: waypoint, position_m: [2, 0, -0.6], speed_m_s: 0.1}\n");
  expect_accepted({"arm"});
  std::vector<std::string> words = {"mission", "fly", file};
  for (const std::string& word : network()) words.push_back(word);
  Program mission("swiftlet", words, folder_.path());
  ASSERT_TRUE(eventually([&] { return mission.errors().find("2/2") != std::string::npos; }, kStuck))
      << mission.errors();
  mission.signal(SIGINT);
  EXPECT_EQ(mission.wait(kStuck), 1);
  EXPECT_NE(mission.errors().find("interrupted; kl7 paused the mission and holds"), std::string::npos)
      << mission.errors();
  EXPECT_EQ(status().at("mission").at("state"), "paused");
}

TEST_F(OnlineFlight, WaitEndsWhenTheControlServiceDies) {
  take_off();
  std::vector<std::string> words = {"goto", "2", "0", "-0.6", "--speed", "0.15"};
  for (const std::string& word : network()) words.push_back(word);
  Program going("swiftlet", words, folder_.path());
  ASSERT_TRUE(eventually([&] { return going.output() == "goto: accepted by kl7\n"; }, kStuck));
  control_.signal(SIGKILL);
  EXPECT_EQ(going.wait(kStuck), 1);
  EXPECT_NE(going.errors().find("no control_status for 3 s"), std::string::npos) << going.errors();
}

// Whether the process handles SIGINT itself.
bool catches_interrupts(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("SigCgt:", 0) == 0) return (std::stoull(line.substr(7), nullptr, 16) >> (SIGINT - 1)) & 1U;
  }
  return false;
}

TEST_F(Online, InterruptEndsTheSearchForAVehicle) {
  for (const char* command : {"arm", "land"}) {
    std::vector<std::string> words = {command, "--timeout", "600"};
    for (const std::string& word : network()) words.push_back(word);
    Program program("swiftlet", words, folder_.path());
    ASSERT_TRUE(eventually([&] { return catches_interrupts(program.pid()); }, kStuck));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(kStuck), 1) << command;
    EXPECT_EQ(program.output(), "");
  }
}

TEST_F(OnlineFlight, WaitOptionReportsACancellation) {
  take_off();
  std::vector<std::string> words = {"goto", "2", "0", "-0.6", "--speed", "0.15", "--wait", "60"};
  for (const std::string& word : network()) words.push_back(word);
  Program going("swiftlet", words, folder_.path());
  ASSERT_TRUE(eventually([&] { return going.output() == "goto: accepted by kl7\n"; }, kStuck));
  expect_accepted({"land"});
  EXPECT_EQ(going.wait(kStuck), 1);
  EXPECT_EQ(going.errors(), "swiftlet: goto: canceled by a newer request: land\n");
}

TEST_F(OnlineFlight, StopTurnsTheRotorsOffInTheAir) {
  take_off();
  expect_accepted({"stop", "--yes"});
  const json now = status();
  EXPECT_EQ(now.at("mode"), "stopped");
  EXPECT_EQ(now.at("reason"), "requested");
  EXPECT_TRUE(reaches("rotors off", [](const json& status) {
    return status.at("vehicle_info").at("rotors_running") == false;
  }));
}

TEST_F(OnlineFlight, FliesAMissionFileToItsEnd) {
  const std::string file = folder_.write("hop.yaml",
                                         "frame: enu\ntolerance_m: 0.1\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                                         "  - {kind: waypoint, position_m: [0.4, 0, 0.6], speed_m_s: 0.8}\n"
                                         "  - {kind: land, speed_m_s: 0.8}\n");
  const ProgramResult unarmed = swiftlet({"mission", "fly", file});
  EXPECT_EQ(unarmed.exit_code, 1);
  EXPECT_EQ(unarmed.errors, "swiftlet: mission hop: not armed; run `swiftlet arm` first\n");
  expect_accepted({"arm"});
  const ProgramResult flown = swiftlet({"mission", "fly", file, "--json"}, kStuck);
  EXPECT_EQ(flown.exit_code, 0) << flown.errors;
  EXPECT_EQ(json::parse(flown.output), json({{"mission", "hop"}, {"accepted", true}, {"completed", true}}));
  EXPECT_NE(flown.errors.find("2/3"), std::string::npos) << "no progress shown: " << flown.errors;
  const json now = status();
  EXPECT_EQ(now.at("mode"), "disarmed");
  EXPECT_EQ(now.at("mission").at("state"), "completed");
  EXPECT_NEAR(now.at("position_ned_m")[1].get<double>(), 0.4, 0.02) << "0.4 m east";
}

TEST_F(OnlineFlight, UploadsStartsPausesResumesSkipsAndClearsAMission) {
  const std::string file =
      folder_.write("walk.yaml",
                    "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                    "  - {kind: waypoint, position_m: [2, 0, -0.6], speed_m_s: 0.1}\n"
                    "  - {kind: waypoint, position_m: [0.3, 0.2, -0.6], speed_m_s: 0.8}\n");
  const auto mission_is = [&](const std::string& state) {
    return reaches(state.c_str(),
                   [&](const json& status) { return status.at("mission").at("state") == state; });
  };
  const auto accepted = [&](const std::string& request) {
    const ProgramResult result = swiftlet({"mission", request, "--no-wait"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, "mission " + request + ": accepted by kl7\n");
  };
  const auto refused = [&](const std::string& request, const std::string& reason) {
    const ProgramResult result = swiftlet({"mission", request});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors, "swiftlet: mission " + request + ": " + reason + "\n");
  };
  accepted("clear");  // without a mission
  // A vehicle of this file could not fly it: nothing is sent.
  std::ifstream kaylion(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml");
  std::string heavy{std::istreambuf_iterator<char>(kaylion), {}};
  const std::string mass = "mass: {value: ";
  const std::size_t at = heavy.find(mass) + mass.size();
  heavy.replace(at, heavy.find(',', at) - at, "0.066");
  const ProgramResult beyond =
      swiftlet({"mission", "upload", file, "--vehicle", folder_.write("heavy.yaml", heavy)});
  EXPECT_EQ(beyond.exit_code, 2) << beyond.errors;
  EXPECT_NE(beyond.errors.find("walk.yaml: kaylion cannot fly it: item "), std::string::npos)
      << beyond.errors;
  EXPECT_EQ(status().at("mission").at("state"), "none");
  const ProgramResult uploaded = swiftlet({"mission", "upload", file, "--json"});
  ASSERT_EQ(uploaded.exit_code, 0) << uploaded.errors;
  const std::string id = std::to_string(json::parse(uploaded.output).at("mission_id").get<std::uint64_t>());
  ASSERT_TRUE(mission_is("uploaded"));
  refused("start", "not armed; run `swiftlet arm` first");
  refused("pause", "no mission is running");
  expect_accepted({"arm"});
  const ProgramResult other = swiftlet({"mission", "start", "--id", "5"});
  EXPECT_EQ(other.errors,
            "swiftlet: mission start: mission 5 is not uploaded; the uploaded mission is " + id + "\n");
  accepted("start");
  ASSERT_TRUE(
      reaches("its second item", [](const json& status) { return status.at("mission").at("item") == 2; }));
  accepted("pause");
  ASSERT_TRUE(mission_is("paused"));
  EXPECT_EQ(status().at("mode"), "holding");
  refused("start", "mission " + id + " is paused; resume or clear it");
  accepted("resume");
  ASSERT_TRUE(mission_is("running"));
  refused("clear", "mission " + id + " is running; end it with hold, goto or land");
  accepted("skip");
  ASSERT_TRUE(mission_is("completed"));
  ASSERT_TRUE(reaches_place(0.3, 0.2, -0.6));
  accepted("clear");
  ASSERT_TRUE(mission_is("none"));
}

TEST_F(OnlineFlight, JoinsASecondTrajectoryDuringTheFirst) {
  const std::string lap = "0.6,0,1\n0.6,0.6,1\n-0.6,0.6,1.2\n-0.6,-0.6,1\n0,0,1\n";
  const std::string tour = folder_.write("tour.csv", "x,y,z\n0,0,1\n" + lap + lap + lap + lap);  // about 20 s
  const std::string other = folder_.write("other.csv", "0.3,0.4,0.8\n0.5,0,0.8\n");
  const std::string mission = folder_.write("hop.yaml",
                                            "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n  - "
                                            "{kind: takeoff, height_m: 1, speed_m_s: 0.8}\n");
  const ProgramResult disarmed = swiftlet({"trajectory", tour});
  EXPECT_EQ(disarmed.exit_code, 1);
  EXPECT_NE(disarmed.errors.find("tour: taken as waypoints in ENU"), std::string::npos) << disarmed.errors;
  EXPECT_NE(disarmed.errors.find("swiftlet: trajectory: on the ground; take off first\n"), std::string::npos)
      << disarmed.errors;
  EXPECT_EQ(swiftlet({"trajectory", mission}).exit_code, 2);
  take_off();
  Inbox<std::string> modes;
  comms::NodeSettings settings{"watcher"};
  settings.vehicle = "kl7";
  settings.domain = lock_.domain();
  settings.localhost_only = true;
  settings.deadlines = false;
  comms::Node watcher(settings);
  const comms::Subscription subscription =
      watcher.subscribe<comms::msg::ControlStatus>(comms::topics::kControlStatus, [&](const auto& status) {
        const std::vector<std::string> before = modes.items();
        const std::string mode = control::to_string(static_cast<control::Mode>(status.mode()));
        if (before.empty() || before.back() != mode) modes.put(mode);
      });
  ASSERT_TRUE(modes.wait_for_count(1));
  expect_accepted({"trajectory", tour});
  ASSERT_TRUE(modes.wait_for_count(2));
  expect_accepted({"trajectory", other});
  ASSERT_TRUE(reaches_mode("holding"));
  ASSERT_TRUE(modes.wait_for_count(3));
  EXPECT_EQ(modes.items(), (std::vector<std::string>{"holding", "trajectory", "holding"}))
      << "it must not hold between the two";
  EXPECT_EQ(status().at("reason"), "trajectory completed");
  ASSERT_TRUE(reaches_place(0.0, 0.5, -0.8));
}

TEST_F(OnlineFlight, ReportsACanceledMission) {
  const std::string file = folder_.write("hover.yaml",
                                         "frame: ned\ntolerance_m: 0.1\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8, hold_s: 100}\n"
                                         "  - {kind: land, speed_m_s: 0.8}\n");
  expect_accepted({"arm"});
  std::vector<std::string> words = {"mission", "fly", file};
  for (const std::string& word : network()) words.push_back(word);
  Program mission("swiftlet", words, folder_.path());
  ASSERT_TRUE(reaches("in the air", [](const json& status) { return status.at("airborne") == true; }));
  expect_accepted({"land"});
  EXPECT_EQ(mission.wait(kStuck), 1);
  EXPECT_NE(
      mission.errors().find("swiftlet: mission hover: mission interrupted: another ground tool sent land"),
      std::string::npos)
      << mission.errors();
  ASSERT_TRUE(reaches_mode("disarmed"));
}

TEST_F(OnlineFlight, FlyAttachesToRunningProcesses) {
  const std::string file = folder_.write("hop.yaml",
                                         "frame: ned\ntolerance_m: 0.1\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                                         "  - {kind: land, speed_m_s: 0.8}\n");
  const ProgramResult result = run_program("swiftlet", attach(file), folder_.path(), kStuck);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_EQ(report.at("vehicle"), "kaylion");
  EXPECT_LT(report.at("rms_3d_m"), 0.01);
  EXPECT_FALSE(plant_.exit_code() || mocap_.exit_code() || control_.exit_code())
      << "fly must not end processes that it did not start";
}

const std::string kHoverMission =
    "frame: ned\ntolerance_m: 0.1\nitems:\n"
    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8, hold_s: 100}\n"
    "  - {kind: land, speed_m_s: 0.8}\n";

TEST_F(OnlineFlight, FlyRefusesAVehicleThatIsInFlight) {
  const std::string file = folder_.write("hover.yaml", kHoverMission);
  expect_accepted({"arm"});
  ASSERT_EQ(swiftlet({"mission", "fly", file, "--no-wait"}).exit_code, 0);
  ASSERT_TRUE(reaches_mode("mission"));
  const ProgramResult result = run_program("swiftlet", attach(file), folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.errors,
            "swiftlet: vehicle kl7 is in flight: mission, item 1 of 2; wait until it has landed, or end its "
            "flight with `swiftlet hold` and `swiftlet land`\n");
  EXPECT_FALSE(std::filesystem::exists(folder_.path() / "record"));
  EXPECT_EQ(status().at("mode"), "mission");
}

TEST_F(OnlineFlight, FlyLeavesTheVehicleToAToolThatTakesOver) {
  Program fly("swiftlet", attach(folder_.write("hover.yaml", kHoverMission)), folder_.path());
  ASSERT_TRUE(reaches_place(0.0, 0.0, -0.5));
  expect_accepted({"goto", "0.2", "0", "-0.5"});
  ASSERT_EQ(fly.wait(kStuck), 1) << fly.errors();
  EXPECT_EQ(json::parse(fly.output()).at("reason"),
            "mission interrupted: another ground tool sent goto; the vehicle is left to it");
  ASSERT_TRUE(reaches_place(0.2, 0.0, -0.5));
  EXPECT_EQ(status().at("mode"), "holding") << "it was not landed";
}

TEST_F(OnlineFlight, FlyReportsASilentVehicle) {
  const std::string file = folder_.write("hover.yaml", kHoverMission);
  Program fly("swiftlet", attach(file), folder_.path());
  ASSERT_TRUE(eventually([&] { return fly.errors().find("1/2 takeoff") != std::string::npos; }, kStuck))
      << fly.errors();
  plant_.signal(SIGKILL);
  ASSERT_EQ(fly.wait(kStuck), 1) << fly.errors();
  EXPECT_EQ(json::parse(fly.output()).at("reason"), "the vehicle has sent nothing for 3 s");
}

TEST_F(OnlineFlight, StatusShowsVehicleBatteryPoseAndPeers) {
  const json now = status();
  EXPECT_EQ(now.at("vehicle"), "kl7");
  EXPECT_EQ(now.at("mode"), "disarmed");
  EXPECT_NEAR(now.at("battery").at("voltage_v").get<double>(), 4.18, 0.05);
  EXPECT_EQ(now.at("vehicle_info").at("imu_rate_hz"), 500.0);
  EXPECT_LT(now.at("pose_age_s"), 0.2);
  for (const char* peer : {"plant", "mocap", "control"})
    EXPECT_EQ(now.at("peers_alive").at(peer), true) << peer;
  for (const auto& [topic, age] : now.at("ages_s").items()) EXPECT_LT(age.get<double>(), 5.0) << topic;
  const ProgramResult text = swiftlet({"status"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_NE(text.output.find("kl7 in domain " + std::to_string(lock_.domain()) + ": disarmed"),
            std::string::npos)
      << text.output;
}

TEST_F(OnlineFlight, StopWithoutATerminalRequiresYes) {
  expect_accepted({"arm"});
  const ProgramResult result = swiftlet({"stop"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("requires --yes without a terminal"), std::string::npos) << result.errors;
  EXPECT_EQ(status().at("mode"), "armed");
}

TEST_F(OnlineFlight, ListShowsTheVehicle) {
  ASSERT_TRUE(eventually(
      [&] {
        const ProgramResult result = run_program(
            "swiftlet", {"list", "--json", "--domain", std::to_string(lock_.domain()), "--localhost-only"},
            folder_.path());
        if (result.exit_code != 0) return false;
        const json list = json::parse(result.output);
        return list.size() == 1 && list[0].at("vehicle") == "kl7" && list[0].at("mode") == "disarmed" &&
               list[0].at("model") == "kaylion" && list[0].at("controllers") == 1 &&
               list[0].at("battery_v") > 4.0 && list[0].at("mocap_hz") > 20.0;
      },
      kStuck));
  const ProgramResult text = run_program(
      "swiftlet", {"list", "--domain", std::to_string(lock_.domain()), "--localhost-only"}, folder_.path());
  EXPECT_EQ(text.output.rfind("vehicle ", 0), 0U) << text.output;
}

TEST_F(Online, ListFailsWithoutVehicles) {
  const ProgramResult result = run_program(
      "swiftlet", {"list", "--time", "0.5", "--domain", std::to_string(lock_.domain()), "--localhost-only"},
      folder_.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(
      result.errors.find("swiftlet: list: no vehicle found in domain " + std::to_string(lock_.domain())),
      std::string::npos)
      << result.errors;
}

TEST_F(OnlineFlight, WatchPrintsLinesWithoutATerminal) {
  const ProgramResult result = swiftlet({"watch", "--duration", "3"});
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_NE(result.output.find("kl7: disarmed (started), at ("), std::string::npos) << result.output;
}

TEST_F(Online, ReportsTheDomainSearchedWhenNothingIsFound) {
  for (const char* command : {"status", "arm"}) {
    const ProgramResult result = swiftlet({command, "--timeout", "0.5"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors, "swiftlet: " + std::string(command) +
                                 ": no control service for vehicle kl7 in domain " +
                                 std::to_string(lock_.domain()) +
                                 "; processes found: none; is it running in this domain (--domain, "
                                 "ROS_DOMAIN_ID)?\n");
  }
}

TEST_F(OnlineFlight, SuggestsLocalhostOnlyOnTheWrongNetwork) {
  const ProgramResult result = run_program(
      "swiftlet",
      {"status", "--timeout", "2", "--domain", std::to_string(lock_.domain()), "--vehicle-name", "kl7"},
      folder_.path());
  if (result.exit_code == 0) {  // on some hosts, all interfaces reach the loopback interface
    EXPECT_NE(result.output.find("kl7 in domain " + std::to_string(lock_.domain())), std::string::npos)
        << result.output;
    return;
  }
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.errors.find("control, mocap, plant (try --localhost-only)"), std::string::npos)
      << result.errors;
}

TEST_F(Online, NamesOtherVehiclesFound) {
  Program plant("swiftlet-plant", network(), folder_.path());
  ASSERT_TRUE(eventually(
      [&] {
        const ProgramResult result =
            run_program("swiftlet",
                        {"arm", "--timeout", "1", "--domain", std::to_string(lock_.domain()),
                         "--vehicle-name", "kl8", "--localhost-only"},
                        folder_.path());
        return result.exit_code == 1 &&
               result.errors.find("processes found: none; other vehicles found: kl7 (--vehicle-name)") !=
                   std::string::npos;
      },
      kStuck));
}

TEST_F(Online, NamesTopicsFoundWhenControlIsMissing) {
  Program plant("swiftlet-plant", network(), folder_.path());
  ASSERT_TRUE(eventually(
      [&] {
        const ProgramResult result = swiftlet({"arm", "--timeout", "1"});
        return result.exit_code == 1 &&
               result.errors.find(
                   "processes found: plant; topics found: battery, clock_reply, ground_truth, imu, ") !=
                   std::string::npos;
      },
      kStuck));
}

}  // namespace
}  // namespace swiftlet::tests

// The online commands with running processes.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "swiftlet/services/dds/node.hpp"
#include "tests/support/online_flight.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using control::MissionState;
using control::Mode;

TEST_F(OnlineFlight, ExecutesEveryCommand) {
  expect_refused({"takeoff"}, "not armed; run `swiftlet arm` first");
  expect_refused({"hold"}, "on the ground; take off first");
  expect_accepted({"arm"});
  ASSERT_TRUE(reaches_mode(Mode::kArmed));
  expect_refused({"takeoff", "0.01"}, "height 0.01 m is too low; minimum is 0.10 m");
  const ProgramResult unconfirmed = swiftlet({"stop"});
  EXPECT_EQ(unconfirmed.exit_code, 2);
  EXPECT_TRUE(contains(unconfirmed.errors, "requires --yes without a terminal")) << unconfirmed.errors;
  EXPECT_EQ(state().mode, Mode::kArmed);
  expect_accepted({"stop", "--yes"});
  ASSERT_TRUE(reaches_mode(Mode::kStopped));
  expect_refused({"arm"}, "emergency stop is active; run `swiftlet disarm` first");
  expect_accepted({"disarm"});
  ASSERT_TRUE(reaches_mode(Mode::kDisarmed));
  expect_accepted({"arm"});
  expect_accepted({"takeoff", "0.6"});
  ASSERT_TRUE(reaches_mode(Mode::kHolding));
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
  ASSERT_TRUE(reaches_mode(Mode::kDisarmed));
  EXPECT_EQ(status().at("request"),
            json({{"kind", "land"}, {"state", "succeeded"}, {"progress", 1.0}, {"result", ""}}));
  ASSERT_TRUE(reaches_place(-0.4, 0.3, 0.0));
}

// GIVEN commands that wait WHEN they complete, time out, are cancelled or interrupted THEN they say so, and an interrupted
// one does not let the vehicle go on.
TEST_F(OnlineFlight, CommandsWaitForTheirResults) {
  const auto done = [this](std::vector<std::string> words) {
    const std::string what = words.front();
    words.insert(words.end(), {"--wait", "60"});
    const ProgramResult result = swiftlet(words);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.output, what + ": accepted by kl7\n" + what + ": done\n");
  };
  const auto accepted = [](const Program& program, const std::string& what) {
    return eventually([&] { return program.output() == what + ": accepted by kl7\n"; });
  };
  done({"arm"});
  done({"takeoff", "0.6"});
  EXPECT_EQ(status().at("mode"), "holding");
  done({"goto", "0.4", "0", "-0.6", "--speed", "0.8"});
  EXPECT_NEAR(status().at("position_ned_m")[0].get<double>(), 0.4, 0.05);
  const std::vector<std::string> slow_goto{"goto", "2", "0", "-0.6", "--speed", "0.02"};
  std::vector<std::string> short_wait = slow_goto;
  short_wait.insert(short_wait.end(), {"--wait", "0.3", "--json"});
  const ProgramResult timed_out = swiftlet(short_wait);
  EXPECT_EQ(timed_out.exit_code, 1);
  EXPECT_EQ(json::parse(timed_out.output),
            json({{"accepted", true}, {"done", false}, {"reason", "not done after 0.3 s"}}));
  done({"hold"});
  {
    Program going = begin({"goto", "2", "0", "-0.6", "--speed", "0.02", "--wait", "60"});
    ASSERT_TRUE(accepted(going, "goto")) << going.errors();
    done({"land"});
    EXPECT_EQ(going.wait(kStuck), 1);
    EXPECT_EQ(going.errors(), "swiftlet: goto: canceled by a newer request: land\n");
  }
  EXPECT_EQ(status().at("mode"), "disarmed");
  {
    ASSERT_NO_FATAL_FAILURE(arm());
    Program takeoff = begin({"takeoff", "2", "--speed", "0.04"});
    ASSERT_TRUE(accepted(takeoff, "takeoff")) << takeoff.errors();
    ASSERT_TRUE(reaches("a height", [](const VehicleState& now) { return now.position_ned_m.z() < -0.2; }));
    takeoff.signal(SIGTERM);
    EXPECT_EQ(takeoff.wait(kStuck), 1);
    EXPECT_EQ(takeoff.errors(), "swiftlet: takeoff: interrupted; kl7 holds\n");
    EXPECT_EQ(status().at("mode"), "holding");
  }
  expect_accepted({"stop", "--yes"});
  const json now = status();
  EXPECT_EQ(now.at("mode"), "stopped");
  EXPECT_EQ(now.at("reason"), "requested");
  EXPECT_TRUE(eventually([&] { return status().at("vehicle_info").at("rotors_running") == false; }));
}

// The line of README.md, or else of docs, as a reader copies it.
std::string documented_chain() {
  std::vector<fs::path> files = {in_source("README.md")};
  for (const auto& entry : fs::recursive_directory_iterator(in_source("docs"))) {
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
  const std::string script = folder_.write("chain.bash", "swiftlet() { '" + program_file("swiftlet") +
                                                             "' \"$@\"" + options + "; }\n" + chain + "\n");
  const ProgramResult result = run_program("/bin/bash", {"--norc", script}, folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_EQ(result.errors, "");
  for (const char* line : {"arm: done\n", "takeoff: done\n", "goto: done\n", "land: done\n"})
    EXPECT_TRUE(contains(result.output, line)) << line << result.output;
  const json now = status();
  EXPECT_EQ(now.at("mode"), "disarmed");
  EXPECT_NEAR(now.at("position_ned_m")[0].get<double>(), 1.0, 0.1);
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
    Program program = begin({command, "--timeout", "600"});
    ASSERT_TRUE(eventually([&] { return catches_interrupts(program.pid()); }));
    program.signal(SIGINT);
    EXPECT_EQ(program.wait(kStuck), 1) << command;
    EXPECT_EQ(program.output(), "");
  }
}

// GIVEN `swiftlet mission start` WHEN the mission completes, is interrupted at the tool, or ended by another one THEN it says so.
TEST_F(OnlineFlight, MissionStartSaysHowTheMissionEnds) {
  const std::string hop = folder_.write("hop.yaml",
                                        "frame: enu\ntolerance_m: 0.1\nitems:\n"
                                        "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                                        "  - {kind: waypoint, position_m: [0.4, 0, 0.6], speed_m_s: 0.8}\n"
                                        "  - {kind: land, speed_m_s: 0.8}\n");
  const auto upload = [&](const std::string& file) {
    const ProgramResult sent = swiftlet({"mission", "upload", file});
    ASSERT_EQ(sent.exit_code, 0) << sent.errors;
  };
  ASSERT_NO_FATAL_FAILURE(upload(hop));
  const ProgramResult unarmed = swiftlet({"mission", "start"});
  EXPECT_EQ(unarmed.exit_code, 1);
  EXPECT_EQ(unarmed.errors, "swiftlet: mission start: not armed; run `swiftlet arm` first\n");
  ASSERT_NO_FATAL_FAILURE(arm());
  const ProgramResult flown = swiftlet({"mission", "start", "--json"});
  EXPECT_EQ(flown.exit_code, 0) << flown.errors;
  EXPECT_EQ(json::parse(flown.output).at("done"), true) << flown.output;
  EXPECT_TRUE(contains(flown.errors, "2/3")) << "no progress shown: " << flown.errors;
  const json landed = status();
  EXPECT_EQ(landed.at("mode"), "disarmed");
  EXPECT_EQ(landed.at("mission").at("state"), "completed");
  EXPECT_NEAR(landed.at("position_ned_m")[1].get<double>(), 0.4, 0.02) << "0.4 m east";

  const std::string walk =
      folder_.write("walk.yaml",
                    "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                    "  - {kind: waypoint, position_m: [2, 0.4, -0.6], speed_m_s: 0.02}\n");
  ASSERT_NO_FATAL_FAILURE(upload(walk));
  {
    ASSERT_NO_FATAL_FAILURE(arm());
    Program mission = begin({"mission", "start"});
    ASSERT_TRUE(eventually([&] { return contains(mission.errors(), "2/2"); })) << mission.errors();
    mission.signal(SIGINT);
    EXPECT_EQ(mission.wait(kStuck), 1);
    EXPECT_TRUE(contains(mission.errors(), "interrupted; kl7 paused the mission and holds"))
        << mission.errors();
    EXPECT_EQ(status().at("mission").at("state"), "paused");
    land();
  }
  ASSERT_NO_FATAL_FAILURE(arm());
  Program mission = begin({"mission", "start"});
  ASSERT_TRUE(reaches("in the air", [](const VehicleState& now) { return now.airborne; }));
  expect_accepted({"land"});
  EXPECT_EQ(mission.wait(kStuck), 1);
  EXPECT_TRUE(contains(mission.errors(), "swiftlet: mission start: canceled by a newer request: land"))
      << mission.errors();
  ASSERT_TRUE(reaches_mode(Mode::kDisarmed));
}

TEST_F(OnlineFlight, UploadsStartsPausesResumesSkipsAndClearsAMission) {
  const std::string file =
      folder_.write("walk.yaml",
                    "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                    "  - {kind: waypoint, position_m: [2, 0, -0.6], speed_m_s: 0.02}\n"
                    "  - {kind: waypoint, position_m: [0.3, 0.2, -0.6], speed_m_s: 0.8}\n");
  const auto mission_is = [&](MissionState wanted) {
    return reaches("state of the mission",
                   [wanted](const VehicleState& now) { return now.mission.state == wanted; });
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
  std::ifstream kaylion(in_source("config/vehicles/kaylion.yaml"));
  std::string heavy{std::istreambuf_iterator<char>(kaylion), {}};
  const std::string mass = "mass: {value: ";
  const std::size_t at = heavy.find(mass) + mass.size();
  heavy.replace(at, heavy.find(',', at) - at, "0.066");
  const ProgramResult beyond =
      swiftlet({"mission", "upload", file, "--vehicle", folder_.write("heavy.yaml", heavy)});
  EXPECT_EQ(beyond.exit_code, 2) << beyond.errors;
  EXPECT_TRUE(contains(beyond.errors, "walk.yaml: kaylion cannot fly it: item ")) << beyond.errors;
  EXPECT_EQ(status().at("mission").at("state"), "none");
  const ProgramResult uploaded = swiftlet({"mission", "upload", file, "--json"});
  ASSERT_EQ(uploaded.exit_code, 0) << uploaded.errors;
  const std::string id = std::to_string(json::parse(uploaded.output).at("mission_id").get<std::uint64_t>());
  ASSERT_TRUE(mission_is(MissionState::kUploaded));
  refused("start", "not armed; run `swiftlet arm` first");
  refused("pause", "no mission is running");
  ASSERT_NO_FATAL_FAILURE(arm());
  const ProgramResult other = swiftlet({"mission", "start", "--id", "5"});
  EXPECT_EQ(other.errors,
            "swiftlet: mission start: mission 5 is not uploaded; the uploaded mission is " + id + "\n");
  accepted("start");
  ASSERT_TRUE(reaches("its second item", [](const VehicleState& now) { return now.mission.item == 2; }));
  accepted("pause");
  ASSERT_TRUE(mission_is(MissionState::kPaused));
  EXPECT_EQ(status().at("mode"), "holding");
  refused("start", "mission " + id + " is paused; resume or clear it");
  accepted("resume");
  ASSERT_TRUE(mission_is(MissionState::kRunning));
  refused("clear", "mission " + id + " is running; end it with hold, goto or land");
  accepted("skip");
  ASSERT_TRUE(mission_is(MissionState::kCompleted));
  ASSERT_TRUE(reaches_place(0.3, 0.2, -0.6));
  accepted("clear");
  ASSERT_TRUE(mission_is(MissionState::kNone));
}

TEST_F(OnlineFlight, JoinsASecondTrajectoryDuringTheFirst) {
  std::string laps;
  for (int i = 0; i < 12; ++i) laps += "0.6,0,1\n0.6,0.6,1\n-0.6,0.6,1.2\n-0.6,-0.6,1\n0,0,1\n";  // 5 s each
  const std::string tour = folder_.write("tour.csv", "x,y,z\n0,0,1\n" + laps);
  const std::string other = folder_.write("other.csv", "0.3,0.4,0.8\n0.5,0,0.8\n");
  const std::string mission = folder_.write("hop.yaml",
                                            "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n  - "
                                            "{kind: takeoff, height_m: 1, speed_m_s: 0.8}\n");
  const ProgramResult disarmed = swiftlet({"trajectory", tour});
  EXPECT_EQ(disarmed.exit_code, 1);
  EXPECT_TRUE(contains(disarmed.errors, "tour: taken as waypoints in ENU")) << disarmed.errors;
  EXPECT_TRUE(contains(disarmed.errors, "swiftlet: trajectory: on the ground; take off first\n"))
      << disarmed.errors;
  EXPECT_EQ(swiftlet({"trajectory", mission}).exit_code, 2);
  take_off();
  Inbox<Mode> modes;
  dds::Node watcher(settings());
  const dds::Subscription subscription = watcher.subscribe<messages::msg::ControlStatus>(
      messages::topics::kControlStatus, [&](const auto& status) {
        const std::vector<Mode> before = modes.items();
        const auto mode = static_cast<Mode>(status.mode());
        if (before.empty() || before.back() != mode) modes.put(mode);
      });
  ASSERT_TRUE(modes.wait_for_count(1));
  expect_accepted({"trajectory", tour});
  ASSERT_TRUE(modes.wait_for_count(2));
  expect_accepted({"trajectory", other});
  ASSERT_TRUE(modes.wait_for_count(3));
  EXPECT_EQ(modes.items(), (std::vector<Mode>{Mode::kHolding, Mode::kTrajectory, Mode::kHolding}))
      << "it must not hold between the two";
  EXPECT_EQ(status().at("reason"), "trajectory completed");
  ASSERT_TRUE(reaches_place(0.0, 0.5, -0.8));
}

class AttachedFlight : public OnlineFlight {
 protected:
  std::vector<std::string> attach(const std::string& mission, const std::string& record) const {
    return {"fly", mission, "--attach", "--json", "--record", (folder_.path() / record).string()};
  }
  const std::string hover_ = folder_.write("hover.yaml",
                                           "frame: ned\ntolerance_m: 0.1\nitems:\n"
                                           "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8, hold_s: 500}\n"
                                           "  - {kind: land, speed_m_s: 0.8}\n");
};

TEST_F(AttachedFlight, FliesOnlyFromTheGroundAndLeavesTheVehicleToAToolThatTakesOver) {
  const std::string file = folder_.write("hop.yaml",
                                         "frame: ned\ntolerance_m: 0.1\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.8}\n"
                                         "  - {kind: land, speed_m_s: 0.8}\n");
  const ProgramResult result = swiftlet(attach(file, "hop"));
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json report = json::parse(result.output);
  EXPECT_EQ(report.at("completed"), true);
  EXPECT_EQ(report.at("vehicle"), "kaylion");
  EXPECT_LT(report.at("rms_3d_m"), 0.01);
  const auto text_of = [](const fs::path& settings) {
    std::ifstream in(settings);
    return std::string{std::istreambuf_iterator<char>(in), {}};
  };
  EXPECT_EQ(text_of(folder_.path() / "hop" / "vehicle.yaml"),
            text_of(in_source("config/vehicles/kaylion.yaml")))
      << "the file that control flies with";
  EXPECT_EQ(text_of(folder_.path() / "hop" / "control.yaml"),
            text_of(in_source("config/control/motor_lag.yaml")));

  Program fly = begin(attach(hover_, "hover"));
  ASSERT_TRUE(reaches_place(0.0, 0.0, -0.5));
  const ProgramResult second = swiftlet(attach(hover_, "second"));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.errors,
            "swiftlet: vehicle kl7 is in flight: mission, item 1 of 2; wait until it has landed, or end its "
            "flight with `swiftlet hold` and `swiftlet land`\n");
  EXPECT_FALSE(fs::exists(folder_.path() / "second"));
  EXPECT_EQ(state().mode, Mode::kMission);

  expect_accepted({"goto", "0.2", "0", "-0.5"});
  ASSERT_EQ(fly.wait(kStuck), 1) << fly.errors();
  EXPECT_EQ(json::parse(fly.output()).at("reason"),
            "mission interrupted: another ground tool sent goto; the vehicle is left to it");
  ASSERT_TRUE(reaches_place(0.2, 0.0, -0.5));
  EXPECT_EQ(state().mode, Mode::kHolding) << "it was not landed";
  EXPECT_FALSE(plant_->exit_code() || mocap_->exit_code() || control_->exit_code())
      << "fly must not end processes that it did not start";
}

// Waits for the wall clock: silence is measured by it.
TEST_F(AttachedFlight, ReportsASilentVehicle) {
  Program fly = begin(attach(hover_, "hover"));
  ASSERT_TRUE(eventually([&] { return contains(fly.errors(), "1/2 takeoff"); })) << fly.errors();
  plant_->signal(SIGKILL);
  ASSERT_EQ(fly.wait(kStuck), 1) << fly.errors();
  EXPECT_EQ(json::parse(fly.output()).at("reason"), "the vehicle has sent nothing for 3 s");
}

TEST_F(OnlineFlight, StatusListAndWatchShowAVehicleOnTheGround) {
  const json now = status();
  EXPECT_EQ(now.at("vehicle"), "kl7");
  EXPECT_EQ(now.at("mode"), "disarmed");
  EXPECT_NEAR(now.at("battery").at("voltage_v").get<double>(), 4.18, 0.05);
  EXPECT_EQ(now.at("vehicle_info").at("imu_rate_hz"), 500.0);
  EXPECT_LT(now.at("pose_age_s"), 0.2);
  for (const char* peer : {"plant", "mocap", "control"})
    EXPECT_EQ(now.at("peers_alive").at(peer), true) << peer;
  for (const auto& [topic, age] : now.at("ages_s").items()) EXPECT_LT(age.get<double>(), 5.0) << topic;
  const ProgramResult text = swiftlet({"status", "--watch", "0.1"});
  EXPECT_EQ(text.exit_code, 0);
  EXPECT_TRUE(contains(text.output, "kl7 in domain " + std::to_string(lock_.domain()) + ": disarmed"))
      << text.output;

  const auto list = [&](std::vector<std::string> words) {
    words.insert(words.begin(), "list");
    words.insert(words.end(),
                 {"--time", "0.8", "--domain", std::to_string(lock_.domain()), "--localhost-only"});
    return run_program("swiftlet", words, folder_.path());
  };
  ASSERT_TRUE(eventually([&] {
    const ProgramResult result = list({"--json"});
    if (result.exit_code != 0) return false;
    const json found = json::parse(result.output);
    return found.size() == 1 && found[0].at("vehicle") == "kl7" && found[0].at("mode") == "disarmed" &&
           found[0].at("model") == "kaylion" && found[0].at("controllers") == 1 &&
           found[0].at("battery_v") > 4.0 && found[0].at("mocap_hz") > 20.0;
  }));
  ASSERT_TRUE(eventually([&] { return list({}).output.rfind("vehicle ", 0) == 0; }));

  Program watch = begin({"watch"});
  ASSERT_TRUE(eventually([&] { return contains(watch.output(), "kl7: disarmed (started), at ("); }))
      << watch.output();
  watch.signal(SIGINT);
  EXPECT_EQ(watch.wait(kStuck), 0) << watch.errors();

  // On some hosts, all interfaces reach the loopback interface.
  ProgramResult elsewhere;
  EXPECT_TRUE(eventually([&] {
    elsewhere = run_program("swiftlet",
                            {"status", "--timeout", "0.5", "--watch", "0.1", "--domain",
                             std::to_string(lock_.domain()), "--vehicle-name", "kl7", "--open-network"},
                            folder_.path());
    if (elsewhere.exit_code == 0)
      return contains(elsewhere.output, "kl7 in domain " + std::to_string(lock_.domain()));
    return elsewhere.exit_code == 1 && contains(elsewhere.errors, "control, mocap, plant");
  })) << elsewhere.errors;
}

TEST_F(Online, SaysWhereNothingWasFound) {
  const std::string domain = std::to_string(lock_.domain());
  const ProgramResult list = run_program(
      "swiftlet", {"list", "--time", "0.4", "--domain", domain, "--localhost-only"}, folder_.path());
  EXPECT_EQ(list.exit_code, 1);
  EXPECT_TRUE(contains(list.errors, "swiftlet: list: no vehicle found in domain " + domain)) << list.errors;
  for (const char* command : {"status", "arm"}) {
    const ProgramResult result = swiftlet({command, "--timeout", "0.1"});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(result.errors,
              "swiftlet: " + std::string(command) + ": no control service for vehicle kl7 in domain " +
                  domain +
                  "; processes found: none; is it running in this domain (--domain, "
                  "ROS_DOMAIN_ID), with the key of this process (--network-key, --security)?\n");
  }
}

TEST_F(Online, NamesWhatIsFoundInPlaceOfTheVehicle) {
  const auto plant = start_in_lockstep("swiftlet-plant");
  const auto says = [&](const std::string& vehicle, const std::string& sentence) {
    return eventually([&] {
      const ProgramResult result =
          run_program("swiftlet",
                      {"arm", "--timeout", "0.3", "--domain", std::to_string(lock_.domain()),
                       "--vehicle-name", vehicle, "--localhost-only"},
                      folder_.path());
      return result.exit_code == 1 && contains(result.errors, sentence);
    });
  };
  EXPECT_TRUE(says("kl8", "processes found: none; other vehicles found: kl7 (--vehicle-name)"));
  EXPECT_TRUE(says("kl7", "processes found: plant; topics found: battery, ground_truth, imu, "));
}

}  // namespace
}  // namespace swiftlet::tests

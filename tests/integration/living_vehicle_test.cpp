// A vehicle that lives: a second start of its name leaves it alone, and who falls silent is reported at once.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <future>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include <nlohmann/json.hpp>

#include "swiftlet/ground/flight/network_transport.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/separate_processes.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using ground::View;
using nlohmann::json;
namespace msg = ground::msg;
namespace topics = messages::topics;

class LivingVehicle : public SeparateProcesses {
 protected:
  ProgramResult run(const std::string& program, std::vector<std::string> words) const {
    words.insert(words.end(), {"--domain", std::to_string(lock_.domain())});
    if (words.front() != "fly") words.emplace_back("--localhost-only");
    return run_program(program, std::move(words), folder_.path());
  }
  // "vehicle kl1 is already in use in domain 20: plant (process 4711 on host lab1) publishes its imu"
  std::string lives(const std::string& name, const Program& process, const std::string& topic) const {
    char host[256] = {};
    ::gethostname(host, sizeof host - 1);
    return "vehicle kl1 is already in use in domain " + std::to_string(lock_.domain()) + ": " + name +
           " (process " + std::to_string(process.pid()) + " on host " + host + ") publishes its " + topic;
  }
  void expect_undisturbed() {
    EXPECT_EQ(mode_log(), "holding: take-off completed\n");
    EXPECT_LT(distance_m(0, 0, -1), 0.05);
  }
  bool eventually_silent(const std::string& who) const {
    json last;
    const bool silent = eventually(
        [&] {
          const ProgramResult result = run("swiftlet", {"status", "--json", "--watch", "0.1"});
          if (result.exit_code != 0) return false;
          last = json::parse(result.output).at("silent");
          return !last.empty() && last[0].at("who") == who && last[0].at("for_s") > 1.0;
        },
        kTimeout);
    EXPECT_TRUE(silent) << last;
    return silent;
  }
};

TEST_F(LivingVehicle, SurvivesASecondPlantMocapAndFlight) {
  start_all();
  hover();
  const ProgramResult plant = run("swiftlet-plant", {"--seed", "2"});
  EXPECT_EQ(plant.exit_code, 1);
  EXPECT_NE(plant.errors.find("swiftlet-plant: " + lives("plant", *plant_, "imu") +
                              "; choose another --vehicle-name or --domain"),
            std::string::npos)
      << plant.errors;
  const ProgramResult mocap = run("swiftlet-mocap", {"--seed", "2"});
  EXPECT_EQ(mocap.exit_code, 1);
  EXPECT_NE(mocap.errors.find(lives("mocap", *mocap_, "mocap_pose")), std::string::npos) << mocap.errors;
  expect_undisturbed();

  const std::string record = folder_.path() / "record";
  const ProgramResult fly =
      run("swiftlet", {"fly", folder_.write("hop.yaml", kHopMission), "--record", record});
  EXPECT_EQ(fly.exit_code, 1);
  EXPECT_NE(fly.errors.find("swiftlet: vehicle kl1 is already in use in domain "), std::string::npos)
      << fly.errors;
  EXPECT_NE(fly.errors.find("; choose another --vehicle-name or --domain, or fly it with --attach"),
            std::string::npos)
      << fly.errors;
  EXPECT_FALSE(std::filesystem::exists(record)) << "nothing was started";
  expect_undisturbed();
}

TEST_F(LivingVehicle, OneOfTwoFlightsThatStartAtOnceIsRefused) {
  const std::string mission = folder_.write("hop.yaml", kHopMission);
  const auto fly = [&](const std::string& name) {
    return std::make_unique<Program>(
        "swiftlet",
        std::vector<std::string>{"fly", mission, "--clock", "lockstep", "--domain",
                                 std::to_string(lock_.domain()), "--record", folder_.path() / name},
        folder_.path());
  };
  const auto first = fly("first");
  const auto second = fly("second");
  std::vector<int> codes = {first->wait(kTimeout), second->wait(kTimeout)};
  std::sort(codes.begin(), codes.end());
  EXPECT_EQ(codes, (std::vector<int>{0, 1})) << first->errors() << second->errors();
  const std::string errors = first->errors() + second->errors();
  EXPECT_NE(errors.find("swiftlet: vehicle kl1 is already in use in domain "), std::string::npos) << errors;
}

// Samples of another program, which does not ask whether the vehicle lives.
TEST_F(LivingVehicle, IsFlownByTheSamplesOfOneSourceOnly) {
  start_all();
  hover();
  dds::Node impostor(node("impostor"));
  auto imu = impostor.publish(topics::kImu);
  auto poses = impostor.publish(topics::kMocapPose);
  std::uint64_t sequence = 1'000'000;
  {
    const dds::PeriodicTask shouting(2ms, [&] {
      const double nan = std::numeric_limits<double>::quiet_NaN();
      msg::Imu sample;
      sample.stamp_ns(stamp_ns());
      sample.sequence_number(++sequence);
      sample.specific_force_frd({nan, nan, nan});
      imu.publish(sample);
      msg::MocapPose pose;
      pose.stamp_ns(stamp_ns());
      pose.sequence_number(sequence);
      pose.tracked(true);
      pose.position_ned({5.0, 5.0, -1.0});
      pose.q_ned_from_frd({1.0, 0.0, 0.0, 0.0});
      poses.publish(pose);
    });
    EXPECT_TRUE(client_->wait(kTimeout, [](const View& view) {
      return std::string(view.control.message.source_conflict().c_str()).find("impostor") !=
             std::string::npos;
    }));
    wait_vehicle_time(1.0);
    expect_undisturbed();
    const ProgramResult status = run("swiftlet", {"status", "--watch", "0.1"});
    EXPECT_NE(status.output.find(" of impostor (process " + std::to_string(::getpid())), std::string::npos)
        << status.output;
    EXPECT_NE(status.output.find(" (process " + std::to_string(plant_->pid())), std::string::npos)
        << status.output;
  }
  EXPECT_NE(control_->errors().find("are ignored: those of "), std::string::npos) << control_->errors();
  EXPECT_TRUE(client_->wait(kTimeout, [](const View& view) {
    return view.control.message.source_conflict().size() == 0;
  })) << "it ends with the last sample";
}

class LivingVehicleInRealTime : public LivingVehicle {
 protected:
  void restart(std::unique_ptr<Program>& process, const std::string& program) const {
    process->signal(SIGKILL);
    process->wait(kTimeout);
    process = start(program);
  }
  static void expect_ready(const Program& process) {
    EXPECT_TRUE(eventually([&] { return process.errors().find("ready: ") != std::string::npos; }, kTimeout))
        << process.errors();
  }
  void expect_reported_silent() {
    const ProgramResult status = run("swiftlet", {"status", "--watch", "0.1"});
    EXPECT_EQ(status.output.rfind("VEHICLE SILENT for ", 0), 0U) << status.output;
    EXPECT_NE(status.output.find("s, since "), std::string::npos) << status.output;
    EXPECT_NE(status.output.find(" (no IMU sample)\n"), std::string::npos) << status.output;
    EXPECT_NE(status.output.find("\nkl1 in domain " + std::to_string(lock_.domain()) + ": holding"),
              std::string::npos)
        << status.output;
    EXPECT_NE(status.output.find("pose       MISSING"), std::string::npos) << status.output;
    EXPECT_NE(status.output.find("\n  controller "), std::string::npos) << status.output;

    ProgramResult list;
    EXPECT_TRUE(eventually([&] {
      list = run("swiftlet", {"list", "--time", "1"});
      return list.output.rfind("kl1: VEHICLE SILENT for ", 0) == 0;
    })) << list.output;
    EXPECT_NE(list.output.find(" holding "), std::string::npos) << list.output;
    ProgramResult facts;
    EXPECT_TRUE(eventually([&] {
      facts = run("swiftlet", {"list", "--json", "--time", "1"});
      const json vehicles = json::parse(facts.output, nullptr, false);
      return vehicles.is_array() && vehicles.size() == 1 && vehicles[0].value("controllers", 0) == 1;
    })) << facts.output;

    ProgramResult watch;
    EXPECT_TRUE(eventually([&] {
      watch = run("swiftlet", {"watch", "--plain", "--duration", "1.5"});
      return watch.output.find("kl1: VEHICLE SILENT for ") != std::string::npos;
    })) << watch.output;
    EXPECT_EQ(watch.output.find("no warnings"), std::string::npos) << watch.output;
  }
  void expect_stop_unconfirmed() {
    const ProgramResult stop = run("swiftlet", {"stop", "--yes"});
    EXPECT_EQ(stop.exit_code, 1) << stop.output;
    EXPECT_EQ(stop.output, "stop: accepted by kl1\n");
    EXPECT_EQ(
        stop.errors.rfind("swiftlet: stop: published and accepted by the controller, not confirmed: rotors "
                          "off is commanded, but the vehicle has been silent for ",
                          0),
        0U)
        << stop.errors;
  }
};

// GIVEN a flight in real time WHEN the vehicle dies THEN it is reported silent first. Started again, its rotors stay off until
// it is disarmed and flown anew; plant and motion capture may be started again at once after a crash.
TEST_F(LivingVehicleInRealTime, IsReportedSilentWhenItDiesAndMayBeStartedAgainAtOnce) {
  start_all_in_real_time();
  wait_until_ready();
  restart(plant_, "swiftlet-plant");
  restart(mocap_, "swiftlet-mocap");
  expect_ready(*plant_);
  expect_ready(*mocap_);
  hover();

  std::atomic<int> rotors_off{0};
  const auto commands = watcher_->subscribe<msg::ActuatorCommand>(
      topics::kActuatorCommand, [&](const msg::ActuatorCommand& command) {
        if (command.rotor_state() == msg::ActuatorCommand_Constants::ROTORS_OFF) ++rotors_off;
      });
  ASSERT_TRUE(eventually([&] { return commands.matched() > 0; }));
  plant_->signal(SIGKILL);
  ASSERT_TRUE(eventually_silent("vehicle"));
  expect_reported_silent();
  EXPECT_EQ(rotors_off, 0);

  clear_history();
  plant_ = start("swiftlet-plant");
  ASSERT_TRUE(reported(control::Mode::kStopped, "the vehicle was restarted")) << mode_log();
  wait_vehicle_time(1.0);
  for (const record::TruthRow& row : truth()) ASSERT_LT(fastest_rotor(row), 20.0);
  EXPECT_FALSE(ask(control::RequestKind::kArm).accepted());
  ASSERT_TRUE(ask(control::RequestKind::kDisarm).accepted());
  hover();

  rotors_off = 0;
  plant_->signal(SIGKILL);
  ASSERT_TRUE(eventually_silent("vehicle"));
  EXPECT_EQ(rotors_off, 0);
  expect_stop_unconfirmed();
  EXPECT_TRUE(eventually([&] { return rotors_off > 0; }));
  const ProgramResult stopped = run("swiftlet", {"status", "--watch", "0.1"});
  EXPECT_NE(stopped.output.find(": stopped (emergency stop is active, but the vehicle is silent"),
            std::string::npos)
      << stopped.output;
  EXPECT_NE(stopped.output.find("  request    stop: accepted"), std::string::npos) << stopped.output;
}

TEST_F(LivingVehicle, ADeadMotionCaptureAndADeadControlServiceAreReportedSilentFirst) {
  start_all();
  wait_until_ready();
  const Program watch("swiftlet",
                      {"watch", "--plain", "--localhost-only", "--domain", std::to_string(lock_.domain())},
                      folder_.path());
  ASSERT_TRUE(
      eventually([&] { return watch.output().find("kl1: disarmed") != std::string::npos; }, kTimeout));
  mocap_->signal(SIGKILL);
  ASSERT_TRUE(eventually_silent("motion capture"));
  ProgramResult list;
  EXPECT_TRUE(eventually([&] {
    list = run("swiftlet", {"list", "--time", "1"});
    return list.output.rfind("kl1: MOTION CAPTURE SILENT for ", 0) == 0;
  })) << list.output;
  control_->signal(SIGKILL);
  EXPECT_TRUE(eventually(
      [&] { return watch.output().find("kl1: CONTROL SERVICE SILENT for ") != std::string::npos; }, kTimeout))
      << watch.output();
}

class SilentProgress final : public io::Progress {
 public:
  void update(int, const std::string&) override {}
  void say(const std::string&) override {}
};

// Only a plant in real time answers clock_request, by which vehicles start together.
// GIVEN a flight that is armed and waits for another one WHEN its start is refused then THEN the vehicle is disarmed again.
TEST_F(LivingVehicleInRealTime, IsDisarmedAgainWhenTheStartIsRefused) {
  start_all_in_real_time();
  wait_until_ready();
  const io::MissionFile mission = io::parse_mission_file(kHopMission, "hop.yaml", control::Limits());
  ground::StartBarrier barrier(2);
  SilentProgress progress;
  const ground::NetworkTransport::Watch watch{[] { return std::nullopt; }, [] { return 0; },
                                              [] { return true; }, &barrier, true};
  auto flight = std::async(std::launch::async, [&]() -> std::string {
    ground::NetworkTransport vehicle(client_, mission, runtime::Clock::kRealtime, watch, progress);
    try {
      simulation::fly_mission(vehicle, 10.0);
    } catch (const simulation::FlightFailure& failure) {
      return failure.what();
    }
    return "completed";
  });
  const auto mode_is = [](const View& view, control::Mode mode) {
    return view.control.message.mode() == static_cast<std::uint8_t>(mode);
  };
  ASSERT_TRUE(client_->wait(kTimeout, [&](const View& view) {
    return mode_is(view, control::Mode::kArmed) &&
           view.mission.message.state() == msg::MissionStatus_Constants::UPLOADED;
  }));
  ASSERT_EQ(run("swiftlet", {"mission", "clear"}).exit_code, 0);
  barrier.ready();
  EXPECT_EQ(flight.get(), "mission refused: no mission is uploaded; upload one first; disarmed");
  EXPECT_TRUE(
      client_->wait(kTimeout, [&](const View& view) { return mode_is(view, control::Mode::kDisarmed); }));
}

// The fence of the mission is about the vehicle, not about the origin.
TEST_F(LivingVehicle, FliesAMissionFromWhereItStands) {
  start_all({}, {"--start", "1.5", "0.5"}, "3");
  wait_until_ready();
  const std::string mission = folder_.write(
      "here.yaml",
      "frame: ned\ntolerance_m: 0.1\ngeofence: {min_m: [1, -0.5, -2], max_m: [2.5, 1.5, 0.2]}\nitems:\n"
      "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n  - {kind: land, speed_m_s: 0.4}\n");
  const ProgramResult fly = run("swiftlet", {"fly", mission, "--attach", "--localhost-only", "--skip-check",
                                             "--json", "--record", folder_.path() / "record"});
  ASSERT_EQ(fly.exit_code, 0) << fly.errors;
  const json report = json::parse(fly.output);
  EXPECT_NEAR(report.at("start_m")[0], 1.5, 0.02);
  EXPECT_NEAR(report.at("start_m")[1], 0.5, 0.02);
}

TEST(Attached, AFlightThatFindsNothingSaysWhereItLooked) {
  const dds::DomainLock lock;
  const TemporaryFolder folder;
  const ProgramResult fly = run_program("swiftlet",
                                        {"fly", "square", "--attach", "--localhost-only", "--domain",
                                         std::to_string(lock.domain()), "--record", folder.path() / "r"},
                                        folder.path());
  EXPECT_EQ(fly.exit_code, 1);
  for (const char* part : {"no control service for vehicle kl1 in domain ",
                           "looked on lo (127.0.0.1) only; without --localhost-only on "})
    EXPECT_NE(fly.errors.find(part), std::string::npos) << part << "\n" << fly.errors;
}

}  // namespace
}  // namespace swiftlet::tests

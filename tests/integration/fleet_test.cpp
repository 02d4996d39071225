// Several vehicles flown by one command.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/record/file/flight_reader.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using nlohmann::json;

double first_east_m(const fs::path& record, const std::string& vehicle) {
  return record::read_flight(mcap::Reader(record / record::kFlightFile), vehicle).truth.at(0).position_ned[1];
}

class FleetFlight : public testing::Test {
 protected:
  // Two vehicles that hover for a minute: long enough for whatever shall happen to them.
  Program hovering() const {
    return Program(
        "swiftlet",
        {"fly",
         folder_.write("hover.yaml",
                       "name: hover\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                       "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
                       "  - {kind: wait, duration_s: 60}\n"
                       "  - {kind: land, speed_m_s: 0.5}\n"),
         "--vehicle-name", "kl1,kl2", "--clock", "lockstep", "--speed", "4", "--record", record().string()},
        folder_.path());
  }
  static void wait_for_item(const std::string& item, Program& fly) {
    ASSERT_TRUE(eventually([&] { return fly.errors().find(item) != std::string::npos || fly.exit_code(); }));
    ASSERT_FALSE(fly.exit_code()) << fly.errors();
  }
  fs::path record() const { return folder_.path() / "record"; }

  TemporaryFolder folder_;
};

TEST_F(FleetFlight, StartsTogetherInRowsServedByThreeProcesses) {
  constexpr std::size_t kVehicles = 3;
  Program fly(
      "swiftlet",
      {"fly", folder_.write("hop.yaml", kHopMission), "--vehicles", std::to_string(kVehicles), "--clock",
       "lockstep", "--spacing", "2", "--per-row", "2", "--record", record().string(), "--json"},
      folder_.path());
  ASSERT_NO_FATAL_FAILURE(wait_for_item("2/3 waypoint", fly));
  EXPECT_EQ(children_of(fly.pid()).size(), 3U) << fly.errors();
  for (const char* const program : {"swiftlet-plant", "swiftlet-mocap", "swiftlet-control"})
    EXPECT_GT(child_of(fly.pid(), program), 0) << program;
  ASSERT_EQ(fly.wait(kStuck), 0) << fly.errors();
  const json report_of_all = json::parse(fly.output());
  EXPECT_EQ(report_of_all.at("completed"), true);
  ASSERT_EQ(report_of_all.at("vehicles").size(), kVehicles);
  for (std::size_t i = 0; i < kVehicles; ++i) {
    const json& report = report_of_all.at("vehicles")[i];
    const std::string name = "kl" + std::to_string(i + 1);
    const double north_m = i < 2 ? -1.0 : 1.0, east_m = i % 2 == 0 ? -1.0 : 1.0;
    EXPECT_EQ(report.at("vehicle_name"), name);
    EXPECT_EQ(report.at("completed"), true);
    EXPECT_EQ(report.at("record_dir"), (record() / name).string());
    EXPECT_EQ(report.at("start_m"), json({north_m, east_m}));
    EXPECT_EQ(report.at("seed"), 1 + i);
    EXPECT_LT(report.at("rms_3d_m"), 0.01);
    EXPECT_NEAR(first_east_m(record(), name), east_m, 0.01);
    EXPECT_TRUE(fs::exists(record() / name / "flight.png"));
  }
  const ProgramResult listed = run_program("swiftlet", {"report", record().string()}, folder_.path());
  EXPECT_EQ(listed.exit_code, 0) << listed.errors;
  EXPECT_NE(listed.output.find("record/kl1  record/kl2  record/kl3"), std::string::npos) << listed.output;
}

TEST_F(FleetFlight, LandsTheOthersWhenOneFails) {
  Program fly = hovering();
  ASSERT_NO_FATAL_FAILURE(wait_for_item("2/3 wait", fly));
  const std::string text = fly.errors();
  const std::size_t domain = text.find(" in domain ");
  ASSERT_NE(domain, std::string::npos) << text;
  ASSERT_EQ(run_program("swiftlet",
                        {"stop", "--yes", "--vehicle-name", "kl2", "--localhost-only", "--domain",
                         std::to_string(std::stoi(text.substr(domain + 11)))},
                        folder_.path())
                .exit_code,
            0);
  EXPECT_EQ(fly.wait(kStuck), 1);
  const std::string errors = fly.errors();
  EXPECT_NE(errors.find("kl2, hover: NOT completed: "), std::string::npos) << errors;
  EXPECT_NE(errors.find("kl1, hover: NOT completed: kl2 failed: "), std::string::npos) << errors;
  EXPECT_NE(errors.find("; landed"), std::string::npos) << errors;
  EXPECT_NE(fly.output().find("0 of 2 flights completed"), std::string::npos) << fly.output();
}

TEST_F(FleetFlight, EndsWhenAProcessThatServesAllDies) {
  Program fly = hovering();
  ASSERT_NO_FATAL_FAILURE(wait_for_item("2/3 wait", fly));
  const pid_t control = child_of(fly.pid(), "swiftlet-control");
  ASSERT_GT(control, 0) << fly.errors();
  kill(control, SIGKILL);
  EXPECT_EQ(fly.wait(kStuck), 1);
  const std::string errors = fly.errors();
  for (const char* const vehicle : {"kl1", "kl2"}) {
    const std::size_t reason = errors.find(vehicle + std::string(", hover: NOT completed: "));
    ASSERT_NE(reason, std::string::npos) << errors;
    EXPECT_NE(errors.find("swiftlet-control was killed by signal 9", reason), std::string::npos) << errors;
  }
  EXPECT_NE(fly.output().find("0 of 2 flights completed"), std::string::npos) << fly.output();
}

class TwoVehicles : public testing::Test {
 protected:
  void SetUp() override {
    for (const char* const vehicle : {"kl1", "kl2"}) {
      ASSERT_TRUE(eventually([&] {
        const ProgramResult result = swiftlet(vehicle, {"status", "--json", "--watch", "0.1"});
        return result.exit_code == 0 && json::parse(result.output).value("has_pose", false);
      })) << vehicle;
    }
  }
  std::vector<std::string> words(const std::string& vehicles, const std::vector<std::string>& more) const {
    std::vector<std::string> words = more;
    words.insert(words.end(), {"--domain", std::to_string(lock_.domain()), "--vehicle-name", vehicles,
                               "--localhost-only"});
    return words;
  }
  std::vector<std::string> lockstep(const std::string& vehicle, std::vector<std::string> more = {}) const {
    more.insert(more.end(), {"--clock", "lockstep"});
    return words(vehicle, more);
  }
  ProgramResult swiftlet(const std::string& vehicles, const std::vector<std::string>& more) const {
    return run_program("swiftlet", words(vehicles, more), folder_.path());
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  Program plant_1_{"swiftlet-plant", lockstep("kl1", {"--speed", "4"}), folder_.path()};
  Program mocap_1_{"swiftlet-mocap", lockstep("kl1"), folder_.path()};
  Program control_1_{"swiftlet-control", lockstep("kl1"), folder_.path()};
  Program plant_2_{"swiftlet-plant", lockstep("kl2", {"--speed", "4"}), folder_.path()};
  Program mocap_2_{"swiftlet-mocap", lockstep("kl2"), folder_.path()};
  Program control_2_{"swiftlet-control", lockstep("kl2"), folder_.path()};
};

TEST_F(TwoVehicles, AnswerOneCommandAsOneOrEachForItself) {
  const auto mode_of = [this](const std::string& vehicle) {
    const ProgramResult result = swiftlet(vehicle, {"status", "--json", "--watch", "0.1"});
    return result.exit_code == 0 ? json::parse(result.output).value("mode", "") : "";
  };
  // GIVEN one that is not there WHEN both are to arm THEN none is asked.
  const ProgramResult absent = swiftlet("kl1,kl9", {"arm", "--timeout", "3"});
  EXPECT_EQ(absent.exit_code, 1);
  EXPECT_EQ(absent.output, "");
  EXPECT_NE(absent.errors.find("swiftlet: arm: kl1: nothing was sent, because kl9 was not found\n"),
            std::string::npos)
      << absent.errors;
  EXPECT_NE(absent.errors.find("swiftlet: arm: kl9: no control service for vehicle kl9"), std::string::npos)
      << absent.errors;
  EXPECT_EQ(mode_of("kl1"), "disarmed");

  ProgramResult armed;
  ASSERT_TRUE(eventually([&] {
    armed = swiftlet("kl1,kl2", {"arm", "--json"});
    return armed.exit_code == 0;
  })) << armed.errors;
  EXPECT_EQ(
      json::parse(armed.output),
      json::parse(R"({"kl1": {"accepted": true, "done": true}, "kl2": {"accepted": true, "done": true}})"));

  // GIVEN one that cannot WHEN both are to take off THEN the other one does.
  const ProgramResult disarmed = swiftlet("kl2", {"disarm"});
  EXPECT_EQ(disarmed.exit_code, 0) << disarmed.errors;
  const ProgramResult taken_off = swiftlet("kl1,kl2", {"takeoff", "0.5", "--wait", "20"});
  EXPECT_EQ(taken_off.exit_code, 1);
  EXPECT_EQ(taken_off.output, "takeoff: accepted by kl1\ntakeoff: kl1: done\n");
  EXPECT_NE(taken_off.errors.find("swiftlet: takeoff: kl2: "), std::string::npos) << taken_off.errors;
  EXPECT_EQ(taken_off.errors.find("kl1"), std::string::npos) << taken_off.errors;
  const ProgramResult landed = swiftlet("kl1", {"land"});
  ASSERT_EQ(landed.exit_code, 0) << landed.errors;

  // GIVEN one that refuses WHEN both are to arm THEN the other one is disarmed again.
  ASSERT_EQ(swiftlet("kl2", {"stop", "--yes"}).exit_code, 0);
  ProgramResult refused;
  ASSERT_TRUE(eventually([&] {
    refused = swiftlet("kl1,kl2", {"arm"});
    return refused.errors.find("kl1: disarmed again, because kl2 did not arm") != std::string::npos;
  })) << refused.errors;
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_EQ(refused.output, "");
  EXPECT_EQ(mode_of("kl1"), "disarmed");
  EXPECT_EQ(mode_of("kl2"), "stopped");

  // GIVEN one that was armed before THEN it stays armed.
  ASSERT_EQ(swiftlet("kl1", {"arm"}).exit_code, 0);
  EXPECT_EQ(swiftlet("kl1,kl2", {"arm"}).exit_code, 1);
  EXPECT_EQ(mode_of("kl1"), "armed");

  const ProgramResult stopped = swiftlet("kl1,kl9", {"stop", "--yes", "--timeout", "3"});
  EXPECT_EQ(stopped.exit_code, 1);
  EXPECT_EQ(stopped.output, "stop: accepted by kl1\nstop: kl1: done\n");
  EXPECT_NE(stopped.errors.find("swiftlet: stop: kl9: "), std::string::npos) << stopped.errors;
}

}  // namespace
}  // namespace swiftlet::tests

// Real processes at each level at which a vehicle can be commanded.
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/plant/model/control_level.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/redundant_flight.hpp"
#include "tests/support/separate_processes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace msg = messages::msg;
using nlohmann::json;
using plant::ControlLevel;

class LevelsInLockstep : public testing::TestWithParam<ControlLevel> {
 protected:
  struct Flight {
    json report;
    std::string trace;
  };

  Flight fly(std::vector<std::string> words, const std::string& name) {
    const auto record = folder_.path() / name;
    words.insert(words.end(), {mission_, "--seed", "4", "--level", plant::to_string(GetParam()), "--trace",
                               "--json", "--record", record.string()});
    const ProgramResult result = run_program("swiftlet", words, folder_.path(), kStuck);
    EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
    return {json::parse(result.output), contents(record / "trace.csv")};
  }

  TemporaryFolder folder_;
  std::string mission_ =
      folder_.write("hop.yaml",
                    "name: hop\nframe: ned\ntolerance_m: 0.1\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
                    "  - {kind: waypoint, position_m: [0.5, -0.3, -0.7], yaw_rad: 0.5, speed_m_s: 0.5}\n"
                    "  - {kind: land, speed_m_s: 0.5}\n");
};

// GIVEN a vehicle of one level WHEN plant, mocap and control fly it in lockstep THEN the flight is that in one process,
// to the last bit. lockstep_test.cpp flies at level actuators.
TEST_P(LevelsInLockstep, EqualsTheFlightInOneProcess) {
  const Flight over_dds = fly({"fly", "--clock", "lockstep"}, "dds");
  const Flight in_process = fly({"sim", "fly"}, "process");
  EXPECT_GT(in_process.trace.size(), 1'000'000U);
  EXPECT_TRUE(over_dds.trace == in_process.trace);
  EXPECT_EQ(over_dds.report.at("rms_3d_m"), in_process.report.at("rms_3d_m"));
  EXPECT_LT(over_dds.report.at("rms_3d_m").get<double>(), 0.05);
}

using RadioInLockstep = LevelsInLockstep;

// GIVEN a radio that delays, reorders and loses packets WHEN the processes fly in lockstep THEN the flight is that in one
// process, to the last bit.
TEST_P(RadioInLockstep, EqualsTheFlightInOneProcess) {
  const std::vector<std::string> radio{"--vehicle",      "crazyflie2", "--radio-delay", "0.02",
                                       "--radio-jitter", "0.006",      "--radio-loss",  "0.02"};
  const auto over_radio = [&](std::vector<std::string> words) {
    words.insert(words.end(), radio.begin(), radio.end());
    return words;
  };
  const Flight over_dds = fly(over_radio({"fly", "--clock", "lockstep"}), "dds");
  const Flight in_process = fly(over_radio({"sim", "fly"}), "process");
  EXPECT_GT(in_process.trace.size(), 1'000'000U);
  EXPECT_TRUE(over_dds.trace == in_process.trace);
  EXPECT_LT(over_dds.report.at("rms_3d_m").get<double>(), 0.05);
}

const auto kLevelsOfFirmware =
    testing::Values(ControlLevel::kRates, ControlLevel::kAttitude, ControlLevel::kTrajectory);
std::string name_of(const testing::TestParamInfo<ControlLevel>& level) {
  return plant::to_string(level.param);
}

INSTANTIATE_TEST_SUITE_P(All, RadioInLockstep, kLevelsOfFirmware, name_of);
INSTANTIATE_TEST_SUITE_P(All, LevelsInLockstep, kLevelsOfFirmware, name_of);

class OdometryInLockstep : public testing::TestWithParam<const char*> {
 protected:
  // The default simulation, in which the vehicle's own estimate jumps in flight, and motion capture is lost for 2 s if it may be.
  std::string simulation() const {
    std::string text = contents(in_source("config/simulation/default.yaml"));
    text +=
        "\nfaults:\n  - {kind: odometry_jump, at_s: 4, for_s: 100, position_ned_m: [0.4, -0.3, 0.1], "
        "yaw_rad: 0.2}\n";
    if (std::string(GetParam()) != "mocap") text += "  - {kind: mocap_stop, at_s: 5, for_s: 2}\n";
    return folder_.write("simulation.yaml", text);
  }
  std::string control() const {
    std::string text = contents(in_source("config/control/motor_lag.yaml"));
    const std::string before = "odometry: {estimate: mocap";
    const std::size_t at = text.find(before);
    EXPECT_NE(at, std::string::npos);
    return folder_.write("control.yaml",
                         text.replace(at, before.size(), std::string("odometry: {estimate: ") + GetParam()));
  }
  std::string trace(std::vector<std::string> words, const std::string& name) const {
    const std::filesystem::path record = folder_.path() / name;
    words.insert(words.end(), {mission_, "--level", "attitude", "--odometry", "own", "--trace", "--control",
                               control(), "--simulation", simulation(), "--record", record.string()});
    const ProgramResult result = run_program("swiftlet", words, folder_.path(), kStuck);
    EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
    return contents(record / "trace.csv");
  }

  TemporaryFolder folder_;
  std::string mission_ = folder_.write("hover.yaml",
                                       "name: hover\nframe: ned\ntolerance_m: 1\nitems:\n"
                                       "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5, hold_s: 5}\n"
                                       "  - {kind: land, speed_m_s: 0.5}\n");
};

// GIVEN a vehicle that brings an estimate of its own, which jumps in flight, in place of IMU samples, and each setting of which
// estimate flies WHEN motion capture is lost THEN the mission is flown to its end, over DDS as in one process to the last bit.
TEST_P(OdometryInLockstep, EqualsTheFlightInOneProcess) {
  const std::string in_process = trace({"sim", "fly"}, "process");
  EXPECT_GT(in_process.size(), 1'000'000U);
  EXPECT_TRUE(trace({"fly", "--clock", "lockstep"}, "dds") == in_process);
}

INSTANTIATE_TEST_SUITE_P(Settings, OdometryInLockstep, testing::Values("mocap", "vehicle", "both"),
                         [](const auto& setting) { return std::string(setting.param); });

class LevelsWithStandby : public testing::TestWithParam<ControlLevel> {
 protected:
  TemporaryFolder folder_;
  RedundantFlight flight_{folder_.path(), {"--level", plant::to_string(GetParam())}};
};

// GIVEN a vehicle of one level and two controllers WHEN the active one dies in a mission THEN the standby continues it
// at the same level.
TEST_P(LevelsWithStandby, TakesOverDuringAMission) {
  flight_.start_controller(5);
  flight_.start_controller(1);
  flight_.wait_for_roles(1, 1);
  flight_.fly(square_laps(0.5, 50));
  flight_.wait("the vehicle flies a side", [&] { return flight_.z_ned() < -0.95 && flight_.speed() > 0.3; });
  const std::int64_t at_ns = flight_.stamp_ns();
  flight_.kill(flight_.active());
  const FlightMetrics metrics = flight_.metrics(at_ns, at_ns + kSecond);
  EXPECT_LT(metrics.longest_gap_ms, 120.0);
  EXPECT_GT(metrics.longest_gap_ms, 10.0) << "the gap must show the kill";
  EXPECT_LT(metrics.largest_deviation_m, 0.1);
  EXPECT_LT(metrics.largest_step_m, 0.01);
  EXPECT_EQ(metrics.changes_of_controller, 1);
  const msg::ControlStatus status = flight_.client().view().control.message;
  EXPECT_EQ(status.mode(), msg::ControlStatus_Constants::MODE_MISSION);
  EXPECT_EQ(status.control_level(), plant::ControlLevels(GetParam()).bits());
}

INSTANTIATE_TEST_SUITE_P(All, LevelsWithStandby,
                         testing::Values(ControlLevel::kRates, ControlLevel::kTrajectory), name_of);

class LevelsOfAVehicle : public SeparateProcesses {
 protected:
  void start_in_lockstep(const std::string& of_vehicle, std::vector<std::string> control = {}) {
    const std::vector<std::string> lockstep{"--clock", "lockstep"};
    control.insert(control.end(), lockstep.begin(), lockstep.end());
    control_ = start("swiftlet-control", control);
    plant_ = start("swiftlet-plant", {"--clock", "lockstep", "--speed", "10", "--level", of_vehicle});
    mocap_ = start("swiftlet-mocap", lockstep);
    wait_until_ready();
  }
};

// GIVEN a vehicle that accepts attitudes only WHEN control is told to send body rates THEN arming is refused with both
// names, and the rotors stay off.
TEST_F(LevelsOfAVehicle, ArmingNamesTheLevelThatTheVehicleDoesNotAccept) {
  start_in_lockstep("attitude", {"--level", "rates"});
  const std::string refusal =
      "cannot arm: the vehicle does not accept commands at level rates, it accepts attitude";
  ground::Result armed;
  ASSERT_TRUE(eventually([&] {
    armed = ask(control::RequestKind::kArm);
    return armed.reason == refusal;
  })) << armed.reason;
  EXPECT_FALSE(armed.accepted());
  EXPECT_FALSE(client_->view().vehicle.message.rotors_running());
}

// GIVEN a vehicle that accepts several levels WHEN control is not told one THEN it takes the lowest.
TEST_F(LevelsOfAVehicle, TheLowestLevelIsTaken) {
  start_in_lockstep("trajectory,attitude");
  EXPECT_TRUE(eventually([&] {
    return client_->view().control.message.control_level() ==
           plant::ControlLevels(ControlLevel::kAttitude).bits();
  }));
  EXPECT_EQ(client_->view().vehicle.message.control_levels(),
            msg::VehicleInfo_Constants::LEVEL_ATTITUDE | msg::VehicleInfo_Constants::LEVEL_TRAJECTORY);
}

}  // namespace
}  // namespace swiftlet::tests

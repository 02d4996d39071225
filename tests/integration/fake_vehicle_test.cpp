// The control service with a vehicle simulated by the test instead of the plant. Any process that publishes
// imu and battery and obeys actuator_command is a vehicle. Its time is as fast as control answers.
#include "tests/support/fake_vehicle.hpp"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using namespace std::chrono_literals;
using control::Mode;
using ground::View;
namespace msg = messages::msg;

constexpr auto kTimeout = kStuck;

class FakeVehicleFlight : public testing::Test {
 protected:
  FakeVehicleFlight()
      : control_("swiftlet-control", {"--domain", std::to_string(lock_.domain()), "--localhost-only"},
                 folder_.path()),
        client_(settings_of("ground", lock_)) {}

  void start_vehicle(plant::ControlLevel level = plant::ControlLevel::kActuators) {
    const auto parameters = io::load_vehicle(in_source("config/vehicles/kaylion.yaml"));
    vehicle_ = std::make_unique<FakeVehicle>(parameters, settings_of("plant", lock_), level);
    ASSERT_TRUE(client_.wait(kTimeout, [](const View& view) { return view.control.message.has_pose(); }))
        << control_.errors();
  }

  ground::Result ask(control::RequestKind kind) {
    control::Request request;
    request.kind = kind;
    request.position_ned.z() = -0.6;
    return client_.request(request, kTimeout);
  }

  bool wait_for(Mode mode) {
    return client_.wait(kTimeout, [mode](const View& view) {
      return view.control.message.mode() == static_cast<std::uint8_t>(mode);
    });
  }

  void take_off() {
    const ground::Result armed = ask(control::RequestKind::kArm);
    ASSERT_TRUE(armed.accepted()) << armed.reason;
    const ground::Result off = ask(control::RequestKind::kTakeoff);
    ASSERT_TRUE(off.accepted()) << off.reason;
  }
  void hover() {
    start_vehicle();
    take_off();
    ASSERT_TRUE(wait_for(Mode::kHolding)) << control_.errors();
  }

  static bool running(const msg::ActuatorCommand& command) {
    return command.rotor_state() == msg::ActuatorCommand_Constants::ROTORS_RUNNING;
  }
  bool rotors_are_off() const {
    const auto command = vehicle_->last_command();
    return command && !running(*command);
  }

  void expect_no_flight_after_a_restart(plant::ControlLevel level) {
    start_vehicle(level);
    take_off();
    ASSERT_TRUE(wait_for(Mode::kHolding)) << control_.errors();
    vehicle_->restart();
    ASSERT_TRUE(wait_for(Mode::kStopped)) << control_.errors();
    EXPECT_STREQ(client_.view().control.message.reason().c_str(), "the vehicle was restarted");
    ASSERT_TRUE(eventually([&] { return vehicle_->samples() > 1000; }, kTimeout));
    EXPECT_EQ(vehicle_->fastest_rotor(), 0.0);
    EXPECT_EQ(vehicle_->highest_m(), 0.0);

    EXPECT_FALSE(ask(control::RequestKind::kArm).accepted());
    ASSERT_TRUE(ask(control::RequestKind::kDisarm).accepted());
    take_off();
    EXPECT_TRUE(wait_for(Mode::kHolding)) << control_.errors();
  }

  dds::DomainLock lock_;
  TemporaryFolder folder_;
  const std::string hop_ = folder_.write("hop.yaml",
                                         "name: hop\nframe: ned\ntolerance_m: 0.2\nitems:\n"
                                         "  - {kind: takeoff, height_m: 0.6, speed_m_s: 0.5, hold_s: 1}\n"
                                         "  - {kind: land, speed_m_s: 0.5}\n");
  Program control_;
  ground::Client client_;
  std::unique_ptr<FakeVehicle> vehicle_;
};

TEST_F(FakeVehicleFlight, RefusesToArmWithoutAVehicle) {
  const ground::Result answer = ask(control::RequestKind::kArm);
  EXPECT_EQ(answer.kind, ground::Result::Kind::kRefused) << answer.reason;
  EXPECT_NE(answer.reason.find("IMU"), std::string::npos) << answer.reason;
}

// The link from the vehicle is cut, that to the vehicle is not.
TEST_F(FakeVehicleFlight, StopReachesAVehicleWhoseSamplesDoNotArrive) {
  hover();
  vehicle_->sends_imu = false;
  ASSERT_TRUE(client_.wait(kTimeout, [](const View& view) { return view.control.message.imu_age_s() > 0.6; }))
      << "the age grows while nothing comes";
  EXPECT_FALSE(client_.view().control.message.has_pose()) << "nor is any pose used";
  ASSERT_FALSE(rotors_are_off()) << "this vehicle obeys its last command";

  const ground::Result answer = ask(control::RequestKind::kStop);
  EXPECT_TRUE(answer.accepted()) << answer.reason;
  EXPECT_NE(answer.reason.find("rotors off is commanded, but the vehicle has been silent for "),
            std::string::npos)
      << answer.reason;
  EXPECT_TRUE(wait_for(Mode::kStopped)) << "it is shown before a sample confirms it";
  EXPECT_EQ(client_.view().control.message.request().state(), msg::RequestStatus_Constants::ACCEPTED);
  EXPECT_EQ(client_.view().control.message.request().id(), answer.key.id);
  EXPECT_TRUE(eventually([&] { return rotors_are_off(); }));

  vehicle_->sends_imu = true;
  EXPECT_TRUE(client_.wait(kTimeout, [](const View& view) {
    return view.control.message.request().state() == msg::RequestStatus_Constants::SUCCEEDED;
  }));
  EXPECT_TRUE(wait_for(Mode::kStopped)) << "the samples that come again do not undo it";
  EXPECT_TRUE(rotors_are_off());
}

TEST_F(FakeVehicleFlight, FliesAMissionWithCommandsThatAnswerItsSamples) {
  start_vehicle();
  ASSERT_TRUE(ask(control::RequestKind::kArm).accepted());
  ASSERT_TRUE(eventually(
      [&] {
        const auto commands = vehicle_->commands();
        return std::count_if(commands.begin(), commands.end(), running) > 250;
      },
      kTimeout))
      << control_.errors();

  const auto commands = vehicle_->commands();
  ASSERT_FALSE(commands.empty());
  EXPECT_FALSE(running(commands.front())) << "rotors ran before arming";
  std::uint64_t last = 0;
  for (const msg::ActuatorCommand& command : commands) {
    EXPECT_GT(command.imu_sequence_number(), last) << "repeated or out of order";
    last = command.imu_sequence_number();
    EXPECT_EQ(command.stamp_ns(), static_cast<std::int64_t>(last) * FakeVehicle::kPeriodNs);
    ASSERT_EQ(command.rotor_count(), 4);
    for (int i = 0; i < 4; ++i)
      EXPECT_EQ(command.throttle()[static_cast<std::size_t>(i)], 0.0) << "armed on the ground";
  }
  EXPECT_GT(commands.back().mocap_sequence_number(), 0U);
  const double expected = static_cast<double>(last - commands.front().imu_sequence_number() + 1);
  EXPECT_GT(static_cast<double>(commands.size()), 0.9 * expected) << "too many samples without a command";

  control::Mission mission;
  mission.items.resize(3);
  mission.items[0].kind = control::MissionItemKind::kTakeoff;
  mission.items[0].position_ned = {0.0, 0.0, -0.5};
  mission.items[1].position_ned = {0.0, 0.0, -0.8};
  mission.items[2].kind = control::MissionItemKind::kLand;
  ground::Result answer = client_.upload(mission, kTimeout);
  ASSERT_TRUE(answer.accepted()) << answer.reason;
  answer = ask(control::RequestKind::kMissionStart);
  ASSERT_TRUE(answer.accepted()) << answer.reason;
  ASSERT_TRUE(client_.wait(kStuck, [&](const View& view) {
    return view.mission.message.mission_id() == client_.mission_id() &&
           view.mission.message.state() == msg::MissionStatus_Constants::COMPLETED;
  })) << control_.errors();
  EXPECT_NEAR(vehicle_->highest_m(), 0.8, 0.05);
  EXPECT_EQ(vehicle_->height_m(), 0.0);
  EXPECT_TRUE(eventually([&] { return rotors_are_off(); }, kTimeout));
}

TEST_F(FakeVehicleFlight, HoldsWhenThePoseReturnsAndDescendsWithoutMocap) {
  hover();
  vehicle_->tracked = false;
  ASSERT_TRUE(wait_for(Mode::kDescent)) << control_.errors();
  vehicle_->tracked = true;
  EXPECT_TRUE(wait_for(Mode::kHolding)) << control_.errors();
  vehicle_->seen_by_mocap = false;
  EXPECT_TRUE(wait_for(Mode::kDescent)) << control_.errors();
  EXPECT_GT(vehicle_->height_m(), 0.1) << "fell";
  EXPECT_TRUE(eventually([&] { return rotors_are_off(); }, kTimeout)) << control_.errors();
  EXPECT_LT(vehicle_->height_m(), 0.1) << "rotors stopped in the air";
}

// GIVEN a vehicle above level actuators that never says that its rotors run WHEN it is to take off THEN control waits for
// 10 s of its time, disarms and says so, and once it does say so it takes off.
TEST_F(FakeVehicleFlight, DoesNotTakeOffBeforeTheVehicleReportsItsRotors) {
  start_vehicle(plant::ControlLevel::kAttitude);
  ASSERT_TRUE(client_.wait(kTimeout, [](const View& view) { return view.vehicle.seen(); }));
  vehicle_->reports_rotors = false;
  const std::uint64_t before = vehicle_->samples();
  take_off();
  ASSERT_TRUE(wait_for(Mode::kTakingOff)) << control_.errors();
  ASSERT_TRUE(wait_for(Mode::kDisarmed)) << control_.errors();
  EXPECT_STREQ(client_.view().control.message.reason().c_str(),
               "the vehicle does not report rotors_running in vehicle_info");
  const double waited_s =
      1e-9 * static_cast<double>(FakeVehicle::kPeriodNs) * static_cast<double>(vehicle_->samples() - before);
  EXPECT_GE(waited_s, 10.0);
  EXPECT_EQ(vehicle_->highest_m(), 0.0);

  vehicle_->reports_rotors = true;
  take_off();
  EXPECT_TRUE(wait_for(Mode::kHolding)) << control_.errors();
  EXPECT_NEAR(vehicle_->height_m(), 0.6, 0.1);
}

// GIVEN hover WHEN the vehicle is restarted at once, with a clock that goes on THEN its rotors stay off until it is armed again.
TEST_F(FakeVehicleFlight, ARestartedVehicleStandsUntilItIsArmedAgain) {
  expect_no_flight_after_a_restart(plant::ControlLevel::kActuators);
}
TEST_F(FakeVehicleFlight, ARestartedVehicleOfLevelAttitudeStandsUntilItIsArmedAgain) {
  expect_no_flight_after_a_restart(plant::ControlLevel::kAttitude);
}

// GIVEN a vehicle that publishes no ground truth, as real ones, WHEN it is flown with `fly --attach` THEN the flight is judged by motion
// capture, and says so.
TEST_F(FakeVehicleFlight, OneWithoutGroundTruthIsJudgedByMotionCapture) {
  start_vehicle(plant::ControlLevel::kAttitude);
  const ProgramResult fly =
      run_program("swiftlet",
                  {"fly", hop_, "--attach", "--skip-check", "--skip-hover-test", "--localhost-only",
                   "--domain", std::to_string(lock_.domain()), "--record", folder_.path() / "record"},
                  folder_.path());
  ASSERT_EQ(fly.exit_code, 0) << fly.output << fly.errors;
  EXPECT_NE(fly.output.find("samples, takeoff to landing, against motion capture\n"), std::string::npos)
      << fly.output;
  EXPECT_NE(fly.output.find("sense to actuate  not measured by the vehicle\n"), std::string::npos)
      << fly.output;
  std::ifstream file(folder_.path() / "record" / "report.json");
  const nlohmann::json report = nlohmann::json::parse(file);
  EXPECT_EQ(report["errors_against"], "motion capture");
  EXPECT_GT(report["peak_3d_m"], 0.0);
  EXPECT_LT(report["peak_3d_m"], 0.2);
}

// GIVEN a vehicle that is not simulated WHEN it is flown with `fly --attach` for the first time THEN a hover test comes first, and is
// remembered.
TEST_F(FakeVehicleFlight, TheFirstFlightIsAHoverTest) {
  start_vehicle(plant::ControlLevel::kAttitude);
  const auto fly = [&](const std::string& record) {
    return run_program("/usr/bin/env",
                       {"XDG_STATE_HOME=" + (folder_.path() / "state").string(), program_file("swiftlet"),
                        "fly", hop_, "--attach", "--skip-check", "--localhost-only", "--domain",
                        std::to_string(lock_.domain()), "--record", folder_.path() / record},
                       folder_.path());
  };
  const ProgramResult first = fly("first");
  EXPECT_EQ(first.exit_code, 0) << first.errors;
  EXPECT_NE(first.errors.find("kl1: first flight: hover test of 2 s at 0.15 m\n"), std::string::npos)
      << first.errors;
  const ProgramResult second = fly("second");
  EXPECT_EQ(second.exit_code, 0) << second.errors;
  EXPECT_EQ(second.errors.find("hover test"), std::string::npos) << second.errors;
}

// `./dev bench --only missions` measures the target of 1 s; the bound here allows for a busy machine.
TEST_F(FakeVehicleFlight, UploadsTheLongestMissionAndStartsOneOf1000WaypointsQuickly) {
  hover();
  control::Mission mission;
  mission.items.resize(control::kMaxMissionItems);
  for (control::MissionItem& item : mission.items) item.position_ned = {0.0, 0.0, -0.7};
  const ground::Result answer = client_.upload(mission, kTimeout);
  EXPECT_TRUE(answer.accepted()) << answer.reason;
  EXPECT_TRUE(client_.wait(kTimeout, [&](const View& view) {
    return view.mission.message.mission_id() == client_.mission_id() &&
           view.mission.message.item_count() == control::kMaxMissionItems;
  }));

  mission.items.resize(1000);
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_TRUE(client_.upload(mission, kTimeout).accepted());
  ASSERT_TRUE(ask(control::RequestKind::kMissionStart).accepted());
  ASSERT_TRUE(client_.wait(kTimeout, [&](const View& view) {
    return view.mission.message.mission_id() == client_.mission_id() &&
           view.mission.message.state() == msg::MissionStatus_Constants::RUNNING;
  }));
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(), 5.0);
}

TEST_F(FakeVehicleFlight, RefusesADifferentMissionOfTheSameId) {
  start_vehicle();
  control::Mission mission;
  mission.items.resize(2);
  for (control::MissionItem& item : mission.items) item.position_ned = {0.0, 0.0, -0.7};
  ASSERT_TRUE(client_.upload(mission, kTimeout).accepted());
  dds::Node node(settings_of("stranger", lock_));
  auto missions = node.publish(messages::topics::kMission);
  std::mutex mutex;
  std::optional<msg::CommandAck> ack;
  const auto acks =
      node.subscribe<msg::CommandAck>(messages::topics::kCommandAck, [&](const msg::CommandAck& got) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (got.client() == 77) ack = got;
      });
  mission.id = client_.mission_id();
  mission.items[1].position_ned.x() = 0.5;
  msg::Mission other = messages::to_message(mission);
  other.client(77);
  ASSERT_TRUE(eventually([&] { return missions.matched() > 0; }, kTimeout));
  ASSERT_TRUE(eventually(
      [&] {
        missions.publish(other);
        const std::lock_guard<std::mutex> lock(mutex);
        return ack.has_value();
      },
      kTimeout));
  EXPECT_FALSE(ack->accepted());
  EXPECT_EQ(ack->reason(),
            "mission id " + std::to_string(mission.id) + " belongs to another mission: upload with a new id");
}

}  // namespace
}  // namespace swiftlet::tests

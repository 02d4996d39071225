// swiftlet-px4 with control and motion capture as processes, and a scripted PX4 (tests/support/px4/scripted_px4.hpp) in the test.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mission.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/io/text_file.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/private_domain.hpp"
#include "tests/support/program.hpp"
#include "tests/support/px4/scripted_px4.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

using control::Mode;
using ground::View;
namespace msg = comms::msg;

constexpr std::uint8_t kPosition = 2, kLand = 18;
constexpr double kHeight_m = 0.6;

std::string fault_of(const View& view) { return view.vehicle.message.fault().c_str(); }

class Px4Flight : public testing::Test {
 protected:
  explicit Px4Flight(ScriptedPx4Settings settings = {})
      : vehicle_(runtime::load_vehicle(SWIFTLET_SOURCE_DIR "/config/vehicles/kaylion.yaml")),
        settings_(std::move(settings)) {}

  std::unique_ptr<Program> start(const std::string& program, std::vector<std::string> arguments = {}) const {
    const std::vector<std::string> common{"--domain", std::to_string(lock_.domain()), "--localhost-only"};
    arguments.insert(arguments.end(), common.begin(), common.end());
    return std::make_unique<Program>(program, arguments, folder_.path());
  }
  // A busy machine must not look like a control that is dead.
  void start_all(const std::string& level, const std::string& silence_s = "1") {
    px4_ = std::make_unique<ScriptedPx4>(vehicle_, settings_of("scripted", lock_), settings_);
    std::vector<std::string> of_bridge{"--control-silence", silence_s, "--instance",
                                       std::to_string(settings_.instance)};
    of_bridge.insert(of_bridge.end(), extra_bridge_.begin(), extra_bridge_.end());
    bridge_ = start("swiftlet-px4", of_bridge);
    mocap_ = start("swiftlet-mocap");
    control_ = start("swiftlet-control", {"--level", level, "--control", control_file_});
    client_ = std::make_unique<ground::Client>(settings_of("ground", lock_));
  }
  void wait_until_ready() {
    ASSERT_TRUE(client_->wait(kStuck, [](const View& view) {
      return view.control.message.has_pose() && fault_of(view).empty() &&
             view.vehicle.message.control_levels() != 0;
    })) << errors();
  }
  std::string errors() const {
    return "px4: " + bridge_->errors() + "control: " + control_->errors() + "mocap: " + mocap_->errors();
  }
  ground::Result ask(std::uint8_t kind) {
    msg::Command command;
    command.kind(kind);
    command.position_ned({0.0, 0.0, -kHeight_m});
    command.speed(0.5);
    return client_->command(command, kStuck);
  }
  bool wait_for(Mode mode) {
    return client_->wait(kStuck, [mode](const View& view) {
      return view.control.message.mode() == static_cast<std::uint8_t>(mode);
    });
  }
  std::string reason() const { return client_->view().control.message.reason().c_str(); }
  void hover() {
    wait_until_ready();
    const ground::Result armed = ask(msg::Command_Constants::ARM);
    ASSERT_TRUE(armed.accepted()) << armed.reason;
    ASSERT_TRUE(eventually([&] { return px4_->armed(); })) << errors();
    const ground::Result off = ask(msg::Command_Constants::TAKEOFF);
    ASSERT_TRUE(off.accepted()) << off.reason;
    ASSERT_TRUE(wait_for(Mode::kHolding)) << reason() << errors();
    EXPECT_NEAR(px4_->height_m(), kHeight_m, 0.15);
  }
  bool fault_is(const std::string& fault) {
    return client_->wait(kStuck, [&](const View& view) { return fault_of(view) == fault; });
  }
  // control's mode with the fault of the vehicle in its reason.
  void expect_stopped_by(const std::string& fault) {
    EXPECT_TRUE(wait_for(Mode::kStopped)) << reason() << errors();
    EXPECT_NE(reason().find(fault), std::string::npos) << reason();
  }

  comms::DomainLock lock_;
  TemporaryFolder folder_;
  const plant::Vehicle vehicle_;
  const ScriptedPx4Settings settings_;
  std::vector<std::string> extra_bridge_;  // arguments
  std::string control_file_ = "motor_lag";
  std::unique_ptr<ScriptedPx4> px4_;
  std::unique_ptr<Program> bridge_, mocap_, control_;
  std::unique_ptr<ground::Client> client_;
};

// GIVEN each level that PX4 offers WHEN a square is flown as a mission THEN it is flown to its end and PX4 disarmed.
class Px4Square : public Px4Flight, public testing::WithParamInterface<const char*> {};

TEST_P(Px4Square, IsFlown) {
  start_all(GetParam());
  wait_until_ready();
  const ground::Result armed = ask(msg::Command_Constants::ARM);
  ASSERT_TRUE(armed.accepted()) << armed.reason;
  ASSERT_TRUE(eventually([&] { return px4_->armed(); })) << errors();
  control::Mission mission;
  mission.items.resize(6);
  mission.items[0].kind = control::MissionItemKind::kTakeoff;
  mission.items[0].position_ned = {0.0, 0.0, -kHeight_m};
  for (std::size_t i = 1; i < 5; ++i) {
    mission.items[i].position_ned = {i == 2 || i == 3 ? 0.5 : 0.0, i == 1 || i == 2 ? 0.5 : 0.0, -kHeight_m};
    mission.items[i].speed = 0.5;
  }
  mission.items[5].kind = control::MissionItemKind::kLand;
  ground::Result answer = client_->upload(mission, kStuck);
  ASSERT_TRUE(answer.accepted()) << answer.reason;
  answer = client_->mission_command(msg::Command_Constants::MISSION_START, client_->mission_id(), kStuck);
  ASSERT_TRUE(answer.accepted()) << answer.reason;
  ASSERT_TRUE(client_->wait(kStuck, [&](const View& view) {
    const auto state = view.mission.message.state();
    return state == msg::MissionStatus_Constants::COMPLETED || state == msg::MissionStatus_Constants::ABORTED;
  })) << errors();
  EXPECT_EQ(client_->view().mission.message.state(), msg::MissionStatus_Constants::COMPLETED)
      << reason() << errors();
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); })) << errors();
  EXPECT_TRUE(fault_is("")) << fault_of(client_->view());
  EXPECT_NEAR(px4_->height_m(), 0.0, 0.05);
  EXPECT_FALSE(px4_->status().failsafe());
  EXPECT_GT(px4_->poses(), 100U);
  const px4_msg::OffboardControlMode mode = *px4_->last_mode();
  EXPECT_EQ(mode.body_rate(), std::string(GetParam()) == "rates");
  EXPECT_EQ(mode.attitude(), std::string(GetParam()) == "attitude");
  EXPECT_EQ(mode.velocity(), std::string(GetParam()) == "trajectory");
}

INSTANTIATE_TEST_SUITE_P(Levels, Px4Square, testing::Values("rates", "attitude", "trajectory"),
                         [](const auto& level) { return std::string(level.param); });

// GIVEN a take-off that is commanded together with arming, as `swiftlet fly` does THEN no thrust is commanded before
// PX4 has armed, a second later: it would start its rotors with that thrust.
class Px4Arming : public Px4Square {};

TEST_P(Px4Arming, IsAwaitedByTheTakeOff) {
  std::mutex mutex;
  double before_n = 0.0, after_n = 0.0;  // greatest commanded thrust
  comms::Node node(settings_of("listener", lock_));
  const auto note = [&](double thrust_n) {
    const std::lock_guard<std::mutex> lock(mutex);
    double& greatest_n = px4_->armed() ? after_n : before_n;
    greatest_n = std::max(greatest_n, thrust_n);
  };
  start_all(GetParam());
  const comms::Subscription rates = node.subscribe<msg::RatesSetpoint>(
      comms::topics::kRatesSetpoint, [&](const auto& message) { note(message.thrust_n()); });
  const comms::Subscription attitudes = node.subscribe<msg::AttitudeSetpoint>(
      comms::topics::kAttitudeSetpoint, [&](const auto& message) { note(message.thrust_n()); });
  // Upward acceleration that is asked for, above that of a fall.
  const comms::Subscription trajectories =
      node.subscribe<msg::TrajectorySetpoint>(comms::topics::kTrajectorySetpoint, [&](const auto& message) {
        const bool running = message.rotor_state() == msg::ActuatorCommand_Constants::ROTORS_RUNNING;
        note(running ? plant::kGravity - message.acceleration_ned()[2] : 0.0);
      });
  wait_until_ready();
  ASSERT_TRUE(ask(msg::Command_Constants::ARM).accepted());
  ASSERT_TRUE(ask(msg::Command_Constants::TAKEOFF).accepted());
  ASSERT_TRUE(wait_for(Mode::kHolding)) << reason() << errors();
  EXPECT_NEAR(px4_->height_m(), kHeight_m, 0.15);
  const std::lock_guard<std::mutex> lock(mutex);
  EXPECT_GT(after_n, 0.1);
  EXPECT_NEAR(before_n, 0.0, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Levels, Px4Arming, testing::Values("rates", "attitude", "trajectory"),
                         [](const auto& level) { return std::string(level.param); });

class Px4Failures : public Px4Flight {};

TEST_F(Px4Failures, DeathOfControlEndsTheStreamAndLands) {
  start_all("attitude", "0.5");
  hover();
  control_->signal(SIGKILL);
  ASSERT_TRUE(eventually([&] { return px4_->status().nav_state() == kLand; })) << bridge_->errors();
  EXPECT_FALSE(px4_->status().failsafe()) << "it was told to, before its failsafe acts";
  const std::uint64_t modes = px4_->offboard_modes();
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); })) << bridge_->errors();
  EXPECT_EQ(px4_->offboard_modes(), modes) << "nothing was streamed after its death";
  EXPECT_NEAR(px4_->height_m(), 0.0, 0.05);
}

TEST_F(Px4Failures, DeathOfTheBridgeLeavesPx4ToItsFailsafe) {
  start_all("trajectory");
  hover();
  bridge_->signal(SIGKILL);
  ASSERT_TRUE(eventually([&] { return px4_->status().failsafe(); }));
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); }));
  EXPECT_NEAR(px4_->height_m(), 0.0, 0.05);
}

TEST_F(Px4Failures, ThePilotTakesOver) {
  start_all("rates");
  hover();
  px4_->pilot_selects(kPosition);
  ASSERT_TRUE(fault_is("PX4 is in mode Position (pilot or ground station)")) << errors();
  expect_stopped_by("PX4 is in mode Position (pilot or ground station)");
  const std::uint64_t modes = px4_->offboard_modes();
  const std::size_t commands = px4_->commands().size();
  ASSERT_TRUE(
      client_->wait(kStuck, [&, from = client_->view().vehicle.message.sequence_number()](const View& view) {
        return view.vehicle.message.sequence_number() > from + 1;
      }));
  EXPECT_TRUE(px4_->armed()) << "rotors off of control do not reach the pilot's vehicle";
  EXPECT_EQ(px4_->status().nav_state(), kPosition);
  EXPECT_EQ(px4_->offboard_modes(), modes);
  EXPECT_EQ(px4_->commands().size(), commands);
}

TEST_F(Px4Failures, TheKillSwitchIsNamed) {
  start_all("trajectory");
  wait_until_ready();
  ASSERT_TRUE(ask(msg::Command_Constants::ARM).accepted());
  // Before the bridge has seen it armed, a kill is an order to arm that was not obeyed.
  ASSERT_TRUE(eventually([&] {
    return bridge_->errors().find("armed, in offboard mode") != std::string::npos;
  })) << errors();
  px4_->kill();
  ASSERT_TRUE(fault_is("PX4 disarmed: kill switch")) << errors();
  expect_stopped_by("PX4 disarmed: kill switch");
}

TEST_F(Px4Failures, TheKillSwitchStopsTheFlight) {
  start_all("trajectory");
  hover();
  px4_->kill();
  EXPECT_TRUE(wait_for(Mode::kStopped)) << "for it, or for the impact that follows" << errors();
  EXPECT_FALSE(px4_->armed());
}

TEST_F(Px4Failures, LossOfTheLinkToPx4IsItsFailsafe) {
  start_all("attitude");
  hover();
  px4_->receives = false;
  ASSERT_TRUE(eventually([&] { return px4_->status().failsafe(); }));
  ASSERT_TRUE(client_->wait(kStuck, [](const View& view) {
    return fault_of(view).find("(failsafe)") != std::string::npos;
  })) << errors();
  expect_stopped_by("(failsafe)");
}

TEST_F(Px4Failures, LossOfTheLinkFromPx4Lands) {
  start_all("attitude");
  hover();
  px4_->sends = false;
  ASSERT_TRUE(eventually([&] { return px4_->status().nav_state() == kLand; })) << errors();
  EXPECT_TRUE(fault_is("the link to PX4 is lost: no samples")) << errors();
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); }));
  EXPECT_NEAR(px4_->height_m(), 0.0, 0.05);
}

TEST_F(Px4Failures, ARefusalToArmIsToldWithPx4sReason) {
  start_all("rates");
  wait_until_ready();
  px4_->refuse_to_arm(true);
  ASSERT_TRUE(ask(msg::Command_Constants::ARM).accepted());
  expect_stopped_by("PX4 does not arm: temporarily rejected (failure detector: an ESC did not arm)");
  EXPECT_FALSE(px4_->armed());
}

TEST_F(Px4Failures, PosesHaveTheirFrameAndUnusedFields) {
  start_all("rates");
  wait_until_ready();
  ASSERT_TRUE(eventually([&] { return px4_->poses() > 10; })) << errors();
  const px4_msg::VehicleOdometry pose = *px4_->last_pose();
  EXPECT_EQ(pose.pose_frame(), 1);
  EXPECT_EQ(pose.timestamp(), 0U) << "now";
  EXPECT_GT(pose.position_variance()[0], 0.0F);
  EXPECT_TRUE(std::isnan(pose.velocity()[0]));
}

class Px4OfAnotherVersion : public Px4Flight {
 protected:
  static ScriptedPx4Settings newer() {
    ScriptedPx4Settings settings;
    settings.status_topic = "/out/vehicle_status_v4";
    return settings;
  }
  Px4OfAnotherVersion() : Px4Flight(newer()) {}
};

TEST_F(Px4OfAnotherVersion, IsRefusedByName) {
  start_all("rates");
  EXPECT_TRUE(fault_is(
      "PX4 publishes /fmu/out/vehicle_status_v4, but swiftlet-px4 knows vehicle_status_v1, that of PX4 1.16"))
      << errors();
  EXPECT_FALSE(ask(msg::Command_Constants::ARM).accepted());
  EXPECT_EQ(px4_->offboard_modes(), 0U);
}

// GIVEN control that is sent PX4's own estimate in place of its IMU THEN it flies, and tells how far it is from motion capture.
class Px4Odometry : public Px4Flight {};

TEST_F(Px4Odometry, FliesAndLands) {
  extra_bridge_ = {"--samples", "odometry"};
  start_all("attitude");
  hover();
  const msg::ControlStatus status = client_->view().control.message;
  EXPECT_GE(status.odometry_distance_m(), 0.0);
  EXPECT_LT(status.odometry_distance_m(), 0.1);
  EXPECT_EQ(status.estimate_source(), msg::ControlStatus_Constants::ESTIMATE_OF_MOCAP);
  ASSERT_TRUE(ask(msg::Command_Constants::LAND).accepted());
  EXPECT_TRUE(wait_for(Mode::kDisarmed)) << reason() << errors();
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); }));
}

// PX4 publishes its estimate late by a varying time. Its stamp is that of the sample: in equal intervals.
TEST_F(Px4Odometry, IsStampedByItsSample) {
  extra_bridge_ = {"--samples", "odometry"};
  std::mutex mutex;
  std::vector<double> off_us;  // of the interval
  std::int64_t last_ns = 0;
  comms::Node node(settings_of("listener", lock_));
  const comms::Subscription subscription =
      node.subscribe<msg::VehicleOdometry>(comms::topics::kVehicleOdometry, [&](const auto& message) {
        const std::lock_guard<std::mutex> lock(mutex);
        if (last_ns > 0)
          off_us.push_back(std::abs(1e-3 * static_cast<double>(message.stamp_ns() - last_ns) - 1e4));
        last_ns = message.stamp_ns();
      });
  start_all("attitude");
  ASSERT_TRUE(eventually([&] {
    const std::lock_guard<std::mutex> lock(mutex);
    return off_us.size() > 200;
  })) << errors();
  const std::lock_guard<std::mutex> lock(mutex);
  std::nth_element(off_us.begin(), off_us.begin() + 100, off_us.end());
  EXPECT_LT(off_us[100], 1500.0);
}

// GIVEN control that is flown by PX4's own estimate, which is made from the poses of motion capture WHEN these end
// THEN it descends without position, although PX4 still sends one.
TEST_F(Px4Odometry, MadeFromMotionCaptureIsLostWithIt) {
  std::string settings = runtime::read_text_file(SWIFTLET_SOURCE_DIR "/config/control/motor_lag.yaml");
  const std::string mocap = "odometry: {estimate: mocap";
  ASSERT_NE(settings.find(mocap), std::string::npos);
  control_file_ = folder_.write(
      "own.yaml", settings.replace(settings.find(mocap), mocap.size(), "odometry: {estimate: vehicle"));
  extra_bridge_ = {"--samples", "odometry"};
  start_all("attitude");
  hover();
  EXPECT_EQ(client_->view().control.message.estimate_source(),
            msg::ControlStatus_Constants::ESTIMATE_OF_VEHICLE);
  mocap_.reset();
  EXPECT_TRUE(wait_for(Mode::kDescent)) << reason() << errors();
}

// GIVEN two instances of PX4 WHEN `swiftlet fly --vehicle px4` flies a mission with both THEN it starts mocap, bridge
// and control, both fly the mission beside each other and land, and the report has both.
class Px4Fly : public Px4Flight {};

TEST_F(Px4Fly, FliesTwoInstances) {
  ScriptedPx4Settings second;
  second.instance = 1;
  second.east_m = 1.0;
  comms::NodeSettings of_second = settings_of("scripted2", lock_);
  of_second.vehicle = "kl2";
  px4_ = std::make_unique<ScriptedPx4>(vehicle_, settings_of("scripted1", lock_), settings_);
  const ScriptedPx4 other(vehicle_, of_second, second);
  const std::string mission =
      folder_.write("hop.yaml",
                    "name: hop\nframe: ned\ntolerance_m: 0.2\nitems:\n"
                    "  - {kind: takeoff, height_m: 0.4, speed_m_s: 0.5}\n"
                    "  - {kind: waypoint, position_m: [0.3, 0, -0.4], speed_m_s: 0.5}\n"
                    "  - {kind: land, speed_m_s: 0.5}\n");
  const ProgramResult result = run_program(
      "swiftlet",
      {"fly", mission, "--vehicle", "px4", "--vehicle-name", "kl1,kl2", "--domain",
       std::to_string(lock_.domain()), "--localhost-only", "--record", folder_.path() / "record", "--json"},
      folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 0) << result.errors << result.output;
  for (const char* const name : {"kl1", "kl2"}) EXPECT_NE(result.output.find(name), std::string::npos);
  for (const ScriptedPx4* const px4 : {static_cast<const ScriptedPx4*>(px4_.get()), &other}) {
    EXPECT_FALSE(px4->armed());
    EXPECT_GT(px4->setpoints(), 300U);
    EXPECT_TRUE(px4->last_mode()->attitude()) << "level attitude, unless told";
    EXPECT_NEAR(px4->height_m(), 0.0, 0.05);
  }
}

TEST_F(Px4Fly, RefusesOptionsOfTheSimulation) {
  const ProgramResult result = run_program(
      "swiftlet", {"fly", "square", "--vehicle", "px4", "--clock", "lockstep"}, folder_.path(), kStuck);
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("--vehicle px4: PX4 is no simulation of swiftlet-plant"), std::string::npos)
      << result.errors;
}

class Px4WithWeakRotors : public Px4Flight {
 protected:
  static ScriptedPx4Settings weak_second() {
    ScriptedPx4Settings settings;
    settings.instance = 2;
    settings.thrust_factor = 0.8;
    return settings;
  }
  Px4WithWeakRotors() : Px4Flight(weak_second()) {}
};

// GIVEN the second instance of PX4, whose rotors give 80 % of the thrust of the vehicle file THEN it hovers all the same.
TEST_F(Px4WithWeakRotors, HoversAndLands) {
  start_all("attitude");
  hover();
  ASSERT_TRUE(ask(msg::Command_Constants::LAND).accepted());
  EXPECT_TRUE(wait_for(Mode::kDisarmed)) << reason() << errors();
  ASSERT_TRUE(eventually([&] { return !px4_->armed(); }));
}

}  // namespace
}  // namespace swiftlet::tests

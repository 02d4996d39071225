// Flights of the bridge's vehicle with the flight controller, motion capture and a simulated PX4 (tests/support/px4), in one thread
// and by a clock of their own.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/services/px4/px4_vehicle.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/px4/px4_simulation.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::tests::px4_flight_test {

using control::Mode;
using control::Reason;
using control::RequestKind;
using plant::ControlLevel;

constexpr std::uint8_t kPosition = 2, kAutoLand = 18;
constexpr double kHeight_m = 0.6;
constexpr std::int64_t kStampsLagUs = 40'000;
constexpr std::int64_t kInfoPeriodTicks = 2;  // a change is told within 20 ms

control::ControlSettings control_settings() {
  return io::load_control_settings(in_source("config/control/motor_lag.yaml"));
}

class Px4Flight : public testing::Test {
 protected:
  void start(ControlLevel level, px4::Samples samples = px4::Samples::kImu, double control_silence_s = 0.2,
             double thrust_factor = 1.0) {
    px4::Px4VehicleSettings settings;
    settings.vehicle = kaylion();
    settings.levels = level;
    settings.samples = samples;
    settings.control_silence_s = control_silence_s;
    vehicle_.emplace(settings);
    px4_ = std::make_unique<Px4Simulation>(kaylion(), thrust_factor);
    control_ = std::make_unique<control::FlightController>(kaylion(), settings_);
    control_->set_levels(level, level);
    ASSERT_TRUE(until([&] { return control_->status().has_pose && has_battery_ && fault().empty(); }))
        << fault();
  }

  // 10 ms.
  void tick() {
    now_ns_ += Px4Simulation::kPeriodNs;
    const Px4Messages messages = px4_->advance(static_cast<std::uint64_t>(now_ns_ / 1000 - kStampsLagUs));
    see();
    if (px4_sends_) deliver(messages);
    const auto command = bridge_lives_ ? vehicle_->update(now_ns_) : std::nullopt;
    if (command && px4_receives_) {
      const auto ack = px4_->on_command(*command);
      if (ack && px4_sends_) vehicle_->on_ack(*ack);
    }
    if (++ticks_ % kInfoPeriodTicks == 0) inform_control();
  }
  void see() {
    const plant::TruthSample truth = px4_->truth();
    const auto pose = mocap_.update(now_ns_, truth.position_ned, truth.q_ned_from_frd);
    if (!pose || !mocap_lives_) return;
    control_->on_pose(*pose);
    const auto odometry = bridge_lives_ ? vehicle_->on_pose(*pose, now_ns_, 0) : std::nullopt;
    if (odometry && px4_receives_) px4_->on_pose(*odometry);
  }
  void deliver(const Px4Messages& messages) {
    if (!bridge_lives_) return;
    messages::Fault faults[3];
    if (messages.has_status) {
      vehicle_->on_flags(messages.flags);
      vehicle_->on_land_detected(messages.land_detected);
      vehicle_->on_status(messages.status, now_ns_);
    }
    if (messages.battery) {
      if (const auto battery = vehicle_->on_battery(*messages.battery, now_ns_, faults[0])) {
        plant::BatterySample sample;
        EXPECT_FALSE(messages::from_message(*battery, sample));
        control_->on_battery(sample);
        has_battery_ = true;
      }
    }
    if (const auto odometry = vehicle_->on_odometry(messages.odometry, now_ns_, faults[1])) {
      odometry_stamps_ns_.push_back(odometry->stamp_ns());
      answer<plant::OdometrySample>(*odometry);
    }
    if (messages.sensors) {
      if (const auto imu = vehicle_->on_sensors(*messages.sensors, now_ns_, faults[2]))
        answer<plant::ImuSample>(*imu);
    }
    for (const messages::Fault& fault : faults) EXPECT_FALSE(fault) << fault.text;
  }
  template <class Sample, class Message>
  void answer(const Message& message) {
    if (!control_lives_) return;
    Sample sample;
    ASSERT_FALSE(messages::from_message(message, sample));
    control_->set_obeyed(messages::from_message(message.obeyed()));
    const plant::VehicleCommand* command = nullptr;
    if constexpr (std::is_same_v<Sample, plant::ImuSample>) {
      command = &control_->on_imu(sample);
    } else {
      command = &control_->on_odometry(sample);
    }
    note_thrust(*command);
    const auto stream = vehicle_->on_command(*command, now_ns_);
    if (!stream || !px4_receives_) return;
    px4_->on_offboard_mode(stream->mode);
    std::visit(
        [&](const auto& setpoint) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(setpoint)>, std::monostate>)
            px4_->on_setpoint(setpoint);
        },
        stream->setpoint);
  }
  // What control learns from vehicle_info.
  void inform_control() {
    control::VehicleFault text{};
    const std::string fault = bridge_lives_ ? vehicle_->session().fault() : "";
    std::copy_n(fault.c_str(), std::min(fault.size(), text.size() - 1), text.begin());
    control_->set_vehicle_fault(text);
    if (!fault.empty()) last_fault_ = fault;
    control_->set_rotors_running(vehicle_->session().rotors_running());
  }
  // At level trajectory the upward acceleration that is asked for, above that of a fall.
  void note_thrust(const plant::VehicleCommand& command) {
    const bool running = plant::header_of(command).rotor_state == plant::RotorState::kRunning;
    double thrust_n = running ? px4::thrust_of(command).value_or(0.0) : 0.0;
    if (const auto* trajectory = std::get_if<plant::TrajectorySetpoint>(&command))
      thrust_n = running ? plant::kGravity - trajectory->acceleration_ned.z() : 0.0;
    double& greatest_n = armed() ? thrust_when_armed_n_ : thrust_before_n_;
    greatest_n = std::max(greatest_n, thrust_n);
  }

  bool until(const std::function<bool()>& predicate, double seconds = 30.0) {
    for (double t_s = 0.0; t_s < seconds; t_s += 0.01) {
      if (predicate()) return true;
      tick();
    }
    return predicate();
  }
  void run(double seconds) {
    until([] { return false; }, seconds);
  }
  bool until_mode(Mode mode) {
    return until([&] { return control_->status().mode == mode; });
  }
  void ask(RequestKind kind) {
    control::Request request;
    request.key = {1, ++requests_};
    request.kind = kind;
    request.position_ned.z() = -kHeight_m;
    const control::Outcome outcome = control_->request(request);
    ASSERT_TRUE(outcome.accepted) << outcome.reason;
  }
  void hover() {
    ask(RequestKind::kArm);
    ASSERT_TRUE(until([&] { return armed(); })) << fault();
    ask(RequestKind::kTakeoff);
    ASSERT_TRUE(until_mode(Mode::kHolding)) << fault();
    EXPECT_NEAR(px4_->height_m(), kHeight_m, 0.15);
  }
  void expect_landed() {
    EXPECT_TRUE(until([&] { return !armed(); }));
    EXPECT_NEAR(px4_->height_m(), 0.0, 0.05);
  }
  // Control stops for a fault that the vehicle reports.
  void expect_stopped_by(const std::string& sentence) {
    EXPECT_TRUE(until_mode(Mode::kStopped));
    EXPECT_EQ(control_->status().reason, Reason::kVehicleFault);
    EXPECT_NE(last_fault_.find(sentence), std::string::npos) << last_fault_;
  }

  bool armed() const { return px4_->rules().armed(); }
  const std::string& fault() const { return vehicle_->session().fault(); }

  std::int64_t now_ns_ = 1'000'000'000'000;
  std::int64_t ticks_ = 0;
  std::uint64_t requests_ = 0;
  control::ControlSettings settings_ = control_settings();
  std::optional<px4::Px4Vehicle> vehicle_;
  std::unique_ptr<Px4Simulation> px4_;
  std::unique_ptr<control::FlightController> control_;
  plant::Mocap mocap_{{}, 1};
  std::vector<std::int64_t> odometry_stamps_ns_;
  double thrust_before_n_ = 0.0;  // the greatest that control commands, before PX4 is armed
  double thrust_when_armed_n_ = 0.0;
  bool control_lives_ = true;
  bool bridge_lives_ = true;
  bool mocap_lives_ = true;
  bool has_battery_ = false;  // control has heard of it
  std::string last_fault_;    // of which control has heard
  bool px4_sends_ = true;
  bool px4_receives_ = true;
};

// GIVEN each level that PX4 offers and a mission that is started together with arming, as `swiftlet fly` does THEN no thrust is
// commanded before PX4 has armed, a second later: it would start its rotors with that thrust. The mission is flown to its end and
// PX4 disarmed.
class Px4Square : public Px4Flight, public testing::WithParamInterface<ControlLevel> {};

TEST_P(Px4Square, IsFlownWhenPx4HasArmed) {
  start(GetParam());
  control::Mission mission;
  mission.id = 1;
  mission.items.resize(6);
  mission.items[0].kind = control::MissionItemKind::kTakeoff;
  mission.items[0].position_ned = {0.0, 0.0, -kHeight_m};
  for (std::size_t i = 1; i < 5; ++i) {
    mission.items[i].position_ned = {i == 2 || i == 3 ? 0.5 : 0.0, i == 1 || i == 2 ? 0.5 : 0.0, -kHeight_m};
    mission.items[i].speed = 0.5;
  }
  mission.items[5].kind = control::MissionItemKind::kLand;
  control::Request upload;
  upload.key = {1, ++requests_};
  upload.kind = RequestKind::kMissionUpload;
  upload.mission = &mission;
  ASSERT_TRUE(control_->request(upload).accepted);
  ask(RequestKind::kArm);
  ask(RequestKind::kMissionStart);
  const auto state = [&] { return control_->status().mission.state; };
  ASSERT_TRUE(until([&] { return armed(); })) << fault();
  EXPECT_NEAR(thrust_before_n_, 0.0, 1e-9);
  ASSERT_TRUE(until([&] { return !control::is_under_way(state()); })) << fault();
  EXPECT_EQ(state(), control::MissionState::kCompleted) << fault();
  expect_landed();
  EXPECT_GT(thrust_when_armed_n_, 0.1);
  EXPECT_EQ(fault(), "");
  EXPECT_FALSE(px4_->status().failsafe());
  EXPECT_GT(px4_->poses(), 100U);
  const px4_msg::OffboardControlMode mode = *px4_->last_mode();
  EXPECT_EQ(mode.body_rate(), GetParam() == ControlLevel::kRates);
  EXPECT_EQ(mode.attitude(), GetParam() == ControlLevel::kAttitude);
  EXPECT_EQ(mode.velocity(), GetParam() == ControlLevel::kTrajectory);
}

INSTANTIATE_TEST_SUITE_P(Levels, Px4Square,
                         testing::Values(ControlLevel::kRates, ControlLevel::kAttitude,
                                         ControlLevel::kTrajectory),
                         [](const auto& level) { return std::string(plant::to_string(level.param)); });

TEST_F(Px4Flight, DeathOfControlEndsTheStreamAndLands) {
  start(ControlLevel::kAttitude);
  hover();
  control_lives_ = false;
  ASSERT_TRUE(until([&] { return px4_->status().nav_state() == kAutoLand; })) << fault();
  EXPECT_FALSE(px4_->status().failsafe()) << "it was told to, before its failsafe acts";
  const std::uint64_t modes = px4_->offboard_modes();
  expect_landed();
  EXPECT_EQ(px4_->offboard_modes(), modes) << "nothing was streamed after its death";
}

TEST_F(Px4Flight, DeathOfTheBridgeLeavesPx4ToItsFailsafe) {
  start(ControlLevel::kTrajectory);
  hover();
  bridge_lives_ = false;
  ASSERT_TRUE(until([&] { return px4_->status().failsafe(); }));
  expect_landed();
}

TEST_F(Px4Flight, ThePilotTakesOver) {
  start(ControlLevel::kRates);
  hover();
  px4_->pilot_selects(kPosition);
  expect_stopped_by("PX4 is in mode Position (pilot or ground station)");
  const std::uint64_t modes = px4_->offboard_modes();
  const std::size_t commands = px4_->commands().size();
  run(2.0);
  EXPECT_TRUE(armed()) << "rotors off of control do not reach the pilot's vehicle";
  EXPECT_EQ(px4_->status().nav_state(), kPosition);
  EXPECT_EQ(px4_->offboard_modes(), modes);
  EXPECT_EQ(px4_->commands().size(), commands);
}

TEST_F(Px4Flight, TheKillSwitchIsNamed) {
  start(ControlLevel::kTrajectory);
  ask(RequestKind::kArm);
  // Before the bridge has seen it armed, a kill is an order to arm that was not obeyed.
  ASSERT_TRUE(until([&] { return vehicle_->session().phase() == px4::Phase::kFlying; })) << fault();
  px4_->kill();
  expect_stopped_by("PX4 disarmed: kill switch");
}

TEST_F(Px4Flight, TheKillSwitchStopsTheFlight) {
  start(ControlLevel::kTrajectory);
  hover();
  px4_->kill();
  EXPECT_TRUE(until_mode(Mode::kStopped)) << "for it, or for the impact that follows" << fault();
  EXPECT_FALSE(armed());
}

TEST_F(Px4Flight, LossOfTheLinkToPx4IsItsFailsafe) {
  start(ControlLevel::kAttitude);
  hover();
  px4_receives_ = false;
  ASSERT_TRUE(until([&] { return px4_->status().failsafe(); }));
  expect_stopped_by("(failsafe)");
}

TEST_F(Px4Flight, LossOfTheLinkFromPx4Lands) {
  start(ControlLevel::kAttitude);
  hover();
  px4_sends_ = false;
  ASSERT_TRUE(until([&] { return px4_->status().nav_state() == kAutoLand; })) << fault();
  EXPECT_EQ(fault(), "the link to PX4 is lost: no samples");
  expect_landed();
}

TEST_F(Px4Flight, ARefusalToArmIsToldWithPx4sReason) {
  start(ControlLevel::kRates);
  px4_->refuse_to_arm(true);
  ask(RequestKind::kArm);
  expect_stopped_by("PX4 does not arm: temporarily rejected (failure detector: an ESC did not arm)");
  EXPECT_FALSE(armed());
}

TEST_F(Px4Flight, PosesHaveTheirFrameAndUnusedFields) {
  start(ControlLevel::kRates);
  ASSERT_TRUE(until([&] { return px4_->poses() > 10; }));
  const px4_msg::VehicleOdometry pose = *px4_->last_pose();
  EXPECT_EQ(pose.pose_frame(), 1);
  EXPECT_EQ(pose.timestamp(), 0U) << "now";
  EXPECT_GT(pose.position_variance()[0], 0.0F);
  EXPECT_TRUE(std::isnan(pose.velocity()[0]));
}

// GIVEN control that is sent PX4's own estimate in place of its IMU THEN it flies, and tells how far it is from motion capture.
// PX4 publishes its estimate late by a varying time: its stamp is that of the sample, in equal intervals.
TEST_F(Px4Flight, FliesWithPx4sEstimateByTheStampsOfItsSamples) {
  start(ControlLevel::kAttitude, px4::Samples::kOdometry);
  hover();
  const control::OdometryStatus odometry = control_->status().odometry;
  EXPECT_GE(odometry.distance_m, 0.0);
  EXPECT_LT(odometry.distance_m, 0.1);
  EXPECT_FALSE(odometry.in_force);
  ask(RequestKind::kLand);
  EXPECT_TRUE(until_mode(Mode::kDisarmed)) << fault();
  EXPECT_TRUE(until([&] { return !armed(); }));
  ASSERT_GT(odometry_stamps_ns_.size(), 200U);
  for (std::size_t i = 1; i < odometry_stamps_ns_.size(); ++i)
    ASSERT_EQ(odometry_stamps_ns_[i] - odometry_stamps_ns_[i - 1], Px4Simulation::kPeriodNs) << i;
}

// GIVEN control that is flown by PX4's own estimate, which is made from the poses of motion capture WHEN these end
// THEN it descends without position, although PX4 still sends one.
TEST_F(Px4Flight, AnEstimateMadeFromMotionCaptureIsLostWithIt) {
  settings_.estimator.odometry.use = control::OdometryUse::kVehicle;
  start(ControlLevel::kAttitude, px4::Samples::kOdometry);
  hover();
  EXPECT_TRUE(control_->status().odometry.in_force);
  mocap_lives_ = false;
  EXPECT_TRUE(until_mode(Mode::kDescent)) << fault();
}

// GIVEN rotors that give 80 % of the thrust of the vehicle file THEN it hovers all the same.
TEST_F(Px4Flight, HoversAndLandsWithWeakRotors) {
  start(ControlLevel::kAttitude, px4::Samples::kImu, 0.2, 0.8);
  hover();
  ask(RequestKind::kLand);
  EXPECT_TRUE(until_mode(Mode::kDisarmed)) << fault();
  EXPECT_TRUE(until([&] { return !armed(); }));
}

}  // namespace swiftlet::tests::px4_flight_test

// The scripted PX4 against a captured flight of PX4 1.16.0 (tests/data/README.md): it answers the captured inputs as PX4 did.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "px4_msgs/msg/BatteryStatusPubSubTypes.h"
#include "px4_msgs/msg/FailsafeFlagsPubSubTypes.h"
#include "px4_msgs/msg/OffboardControlModePubSubTypes.h"
#include "px4_msgs/msg/SensorCombinedPubSubTypes.h"
#include "px4_msgs/msg/TrajectorySetpointPubSubTypes.h"
#include "px4_msgs/msg/VehicleCommandAckPubSubTypes.h"
#include "px4_msgs/msg/VehicleCommandPubSubTypes.h"
#include "px4_msgs/msg/VehicleLandDetectedPubSubTypes.h"
#include "px4_msgs/msg/VehicleOdometryPubSubTypes.h"
#include "px4_msgs/msg/VehicleStatusPubSubTypes.h"

#include "swiftlet/services/px4/translate.hpp"
#include "swiftlet/services/px4/versions.hpp"
#include "swiftlet/services/px4/words.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/px4/capture.hpp"
#include "tests/support/px4/rules.hpp"

namespace swiftlet::tests::px4_capture_test {

namespace msg = px4::msg;

const std::string kFile = in_source("tests/data/px4_1.16_offboard_flight.pcap.gz");
constexpr double kAnswerTolerance_s = 0.05;
constexpr double kLandingTolerance_s = 2.0;  // the script sees the estimated height, PX4 its throttle
// PX4 lowers its throttle for this long when it touches the ground.
constexpr double kThrottleDown_s = 1.2;

class Px4Capture : public testing::Test {
 protected:
  static const std::vector<CapturedSample>& samples() {
    static const std::vector<CapturedSample> all = samples_of_capture(kFile);
    return all;
  }
  static double seconds(const CapturedSample& sample) {
    return static_cast<double>(sample.time_ns - samples().front().time_ns) * 1e-9;
  }
  template <class PubSubType>
  static std::vector<typename PubSubType::type> all_of(const std::string& name) {
    std::vector<typename PubSubType::type> messages;
    for (const CapturedSample& sample : samples()) {
      if (sample.topic == "rt/fmu/" + name) messages.push_back(message_of<PubSubType>(sample));
    }
    return messages;
  }
};

TEST_F(Px4Capture, EveryLayoutIsThatOnTheWire) {
  const auto sensors = all_of<msg::SensorCombinedPubSubType>("out/sensor_combined");
  ASSERT_GT(sensors.size(), 20U);
  for (const msg::SensorCombined& message : sensors) {
    plant::ImuSample sample;
    const messages::Fault fault = px4::from_px4(message, sample);
    ASSERT_FALSE(fault) << fault.text;
    EXPECT_NEAR(sample.specific_force_frd.norm(), plant::kGravity, 8.0);
  }
  EXPECT_NEAR(sensors.front().accelerometer_m_s2()[2], -plant::kGravity, 0.3) << "at rest";
  for (const msg::BatteryStatus& message : all_of<msg::BatteryStatusPubSubType>("out/battery_status")) {
    plant::BatterySample sample;
    ASSERT_FALSE(px4::from_px4(message, sample));
    EXPECT_NEAR(sample.voltage_v, 16.0, 1.0);
    EXPECT_GT(sample.state_of_charge, 0.4);
  }
  plant::OdometrySample odometry;
  for (const msg::VehicleOdometry& message : all_of<msg::VehicleOdometryPubSubType>("out/vehicle_odometry")) {
    ASSERT_FALSE(px4::from_px4(message, odometry));
    EXPECT_GT(odometry.position_ned.z(), -2.5);
    EXPECT_LT(odometry.velocity_ned.norm(), 3.0);
    EXPECT_LT(odometry.body_rates_frd.norm(), 6.0);
    EXPECT_EQ(odometry.resets % 256, message.reset_counter());
    EXPECT_LE(message.timestamp_sample(), message.timestamp());
    EXPECT_LT(message.timestamp() - message.timestamp_sample(), 20'000U) << "us";
  }
  for (const msg::VehicleStatus& message : all_of<msg::VehicleStatusPubSubType>("out/vehicle_status_v1")) {
    ASSERT_FALSE(px4::check(message)) << px4::check(message).text;
    EXPECT_EQ(message.system_id(), 1);
    EXPECT_EQ(message.vehicle_type(), 1);
  }
  const auto flags = all_of<msg::FailsafeFlagsPubSubType>("out/failsafe_flags");
  ASSERT_FALSE(flags.empty());
  EXPECT_EQ(px4::failing_checks(flags.front()),
            "local position invalid, local velocity invalid, offboard signal lost");
  EXPECT_EQ(px4::failing_checks(flags.back()), "offboard signal lost") << "the stream ended with the landing";
  const auto poses = all_of<msg::VehicleOdometryPubSubType>("in/vehicle_visual_odometry");
  ASSERT_FALSE(poses.empty());
  EXPECT_EQ(poses.front().pose_frame(), 1);
}

TEST_F(Px4Capture, ItsVersionIsKnown) {
  std::vector<std::string> topics;
  for (const CapturedSample& sample : samples()) topics.push_back(sample.topic);
  EXPECT_EQ(px4::version_of(topics, "/fmu").state, px4::VersionState::kKnown);
}

struct Event {
  double at_s = 0.0;
  std::string what;
};

// The changes of PX4's states, captured or scripted, and when they happen.
class Changes {
 public:
  void note(double at_s, const msg::VehicleStatus& status) {
    note(at_s, mode_, "mode " + px4::mode_name(status.nav_state()));
    note(at_s, arming_, status.arming_state() == px4::kArmingStateArmed ? "armed" : "disarmed");
  }
  void note(double at_s, const msg::VehicleLandDetected& land) {
    note(at_s, landed_, land.landed() ? "landed" : "in the air");
  }
  void note(double at_s, const msg::VehicleCommandAck& ack) {
    events.push_back(
        {at_s, "command " + std::to_string(ack.command()) + " " + px4::result_text(ack.result())});
  }
  std::vector<Event> events;

 private:
  void note(double at_s, std::string& last, const std::string& now) {
    if (last != now) events.push_back({at_s, now});
    last = now;
  }
  std::string mode_, arming_, landed_;
};

std::vector<std::string> names_of(std::vector<Event> events) {
  std::vector<std::string> names;
  for (const Event& event : events) names.push_back(event.what);
  std::sort(names.begin(), names.end());
  return names;
}

TEST_F(Px4Capture, TheScriptAnswersTheInputsAsPx4Did) {
  Changes captured, scripted;
  Px4Rules rules;
  Px4Rules::Motion motion;
  double flown_s = -kThrottleDown_s;
  for (const CapturedSample& sample : samples()) {
    const double at_s = seconds(sample);
    const std::int64_t now_us = sample.time_ns / 1000;
    const std::string name = sample.topic.substr(std::string("rt/fmu/").size());
    if (name == "out/vehicle_status_v1")
      captured.note(at_s, message_of<msg::VehicleStatusPubSubType>(sample));
    if (name == "out/vehicle_land_detected")
      captured.note(at_s, message_of<msg::VehicleLandDetectedPubSubType>(sample));
    if (name == "out/vehicle_command_ack") {
      const auto ack = message_of<msg::VehicleCommandAckPubSubType>(sample);
      if (ack.target_system() == 255) captured.note(at_s, ack);  // not of PX4's own commands
    }
    if (name == "out/vehicle_odometry") {
      motion.touches_ground = message_of<msg::VehicleOdometryPubSubType>(sample).position()[2] > -0.08F;
      if (!motion.touches_ground) flown_s = at_s;
      motion.low_thrust = at_s - flown_s > kThrottleDown_s;
    }
    if (name == "in/offboard_control_mode")
      rules.on_offboard_mode(message_of<msg::OffboardControlModePubSubType>(sample), now_us);
    if (name == "in/vehicle_command") {
      const auto ack = rules.on_command(message_of<msg::VehicleCommandPubSubType>(sample), now_us);
      ASSERT_TRUE(ack);
      EXPECT_EQ(ack->target_system(), 255);
      scripted.note(at_s, *ack);
    }
    rules.update(motion, now_us);
    scripted.note(at_s, rules.land_detected());
    scripted.note(at_s, rules.status());
  }
  ASSERT_EQ(captured.events.size(), 11U);
  EXPECT_EQ(names_of(captured.events), names_of(scripted.events));
  for (const Event& event : captured.events) {
    double nearest_s = 1e9;
    for (const Event& other : scripted.events) {
      if (other.what == event.what) nearest_s = std::min(nearest_s, std::abs(other.at_s - event.at_s));
    }
    const bool of_land_detector = event.what == "landed" || event.what == "in the air";
    EXPECT_LT(nearest_s, of_land_detector ? kLandingTolerance_s : kAnswerTolerance_s) << event.what;
  }
}

}  // namespace swiftlet::tests::px4_capture_test

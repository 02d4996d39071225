#include <cmath>
#include <string>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/record/file/standard_messages.hpp"
#include "swiftlet/record/mcap/message_decoder.hpp"
#include "swiftlet/record/recorder/gap_counter.hpp"
#include "swiftlet/record/recorder/sample_queue.hpp"
#include "swiftlet/services/dds/payload.hpp"
#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::record::recording_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using namespace std::chrono_literals;

mcap::Message sample(std::uint16_t channel, const std::string& payload) {
  return {channel, 7, 1, 2, {reinterpret_cast<const std::uint8_t*>(payload.data()), payload.size()}};
}

TEST(SampleQueue, HandsOutWhatWasPutInOrder) {
  record::SampleQueue queue(10'000);
  EXPECT_TRUE(queue.put(sample(1, "first")));
  EXPECT_TRUE(queue.put(sample(2, "")));
  std::vector<std::string> taken;
  const auto keep = [&](const mcap::Message& message) {
    taken.push_back(std::to_string(message.channel_id) + " " +
                    std::string(reinterpret_cast<const char*>(message.payload.data), message.payload.size));
  };
  queue.take_all(0ms, keep);
  EXPECT_EQ(taken, (std::vector<std::string>{"1 first", "2 "}));
  EXPECT_TRUE(queue.put(sample(3, "third")));
  queue.take_all(0ms, keep);
  EXPECT_EQ(taken.back(), "3 third");
}

TEST(SampleQueue, RefusesWhatDoesNotFit) {
  record::SampleQueue queue(2'000);
  const std::string payload(100, 'x');
  int accepted = 0;
  while (queue.put(sample(1, payload))) ++accepted;
  EXPECT_GE(accepted, 5);
  EXPECT_LE(accepted, 10);
  int taken = 0;
  queue.take_all(0ms, [&](const mcap::Message&) { ++taken; });
  EXPECT_EQ(taken, accepted);
  EXPECT_TRUE(queue.put(sample(1, payload)));
}

TEST(GapCounter, CountsWhatIsMissingOfEachWriter) {
  record::GapCounter gaps;
  EXPECT_EQ(gaps.missing_before(1, 50), 0U);
  EXPECT_EQ(gaps.missing_before(1, 51), 0U);
  EXPECT_EQ(gaps.missing_before(2, 7), 0U);
  EXPECT_EQ(gaps.missing_before(1, 54), 2U);
  EXPECT_EQ(gaps.missing_before(2, 8), 0U);
  EXPECT_EQ(gaps.missing_before(2, 8), 0U) << "sent again";
  EXPECT_EQ(gaps.missing_before(1, 55), 0U);
}

TEST(StandardFrames, AreEnuAndFlu) {
  EXPECT_TRUE(record::enu_from_ned({1.0, 2.0, 3.0}).isApprox(Vector3d(2.0, 1.0, -3.0)));
  EXPECT_TRUE(record::flu_from_frd({1.0, 2.0, 3.0}).isApprox(Vector3d(1.0, -2.0, -3.0)));
  // A vector of the vehicle ends at the same place, whichever frames lie between.
  const Quaterniond q_ned_from_frd = Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
  const Vector3d v_frd(0.3, -0.4, 1.2);
  EXPECT_TRUE((record::q_enu_from_flu(q_ned_from_frd) * record::flu_from_frd(v_frd))
                  .isApprox(record::enu_from_ned(q_ned_from_frd * v_frd), 1e-12));
  // Nose to the north, level: a quarter turn from east about up.
  const Quaterniond level = record::q_enu_from_flu(Quaterniond::Identity());
  EXPECT_NEAR(std::abs(level.w()), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(level.z() * level.w(), 0.5, 1e-12);
}

std::map<std::string, mcap::Value> decoded(const record::StandardMessage& message) {
  const mcap::MessageDecoder decoder({1, message.schema->name, "ros2msg", message.schema->definition});
  std::vector<mcap::Value> values;
  EXPECT_TRUE(decoder.decode({message.payload.data(), message.payload.size()}, values)) << message.topic;
  std::map<std::string, mcap::Value> named;
  for (std::size_t i = 0; i < values.size(); ++i) named[decoder.columns()[i].name] = values[i];
  return named;
}

template <class T>
std::vector<record::StandardMessage> following(record::StandardMessages& standard, const std::string& topic,
                                               const T& message, std::int64_t time_ns) {
  const auto payload = dds::to_payload(message);
  return standard.of(topic, {0, 1, time_ns, time_ns, {payload.data(), payload.size()}});
}

TEST(StandardMessages, OfAnEstimateArePoseTransformOdometryAndPath) {
  record::StandardMessages standard("kl1");
  messages::msg::Estimate estimate;
  estimate.position_ned({1.0, 2.0, -3.0});
  estimate.q_ned_from_frd({std::sqrt(0.5), 0.0, 0.0, std::sqrt(0.5)});  // heads east
  estimate.velocity_ned({0.5, 0.25, -0.125});
  estimate.body_rates_frd({0.1, 0.2, 0.3});
  estimate.standard_deviation({0.1, 0.2, 0.3, 0.4, 0.4, 0.4});
  const auto first = following(standard, "estimate", estimate, 5'000'000'007);
  ASSERT_EQ(first.size(), 4U);
  EXPECT_EQ(first[0].topic, "/kl1/pose");
  const auto pose = decoded(first[0]);
  EXPECT_EQ(pose.at("header.stamp.sec"), mcap::Value(std::int64_t{5}));
  EXPECT_EQ(pose.at("header.stamp.nanosec"), mcap::Value(std::uint64_t{7}));
  EXPECT_EQ(pose.at("header.frame_id"), mcap::Value(std::string("map")));
  EXPECT_EQ(pose.at("pose.position.x"), mcap::Value(2.0));
  EXPECT_EQ(pose.at("pose.position.y"), mcap::Value(1.0));
  EXPECT_EQ(pose.at("pose.position.z"), mcap::Value(3.0));
  EXPECT_EQ(first[1].topic, "/tf");
  EXPECT_EQ(decoded(first[1]).at("transforms.length"), mcap::Value(std::uint64_t{1}));
  EXPECT_EQ(first[2].topic, "/kl1/odometry");
  const auto odometry = decoded(first[2]);
  const auto number = [&odometry](const char* name) { return std::get<double>(odometry.at(name)); };
  EXPECT_EQ(odometry.at("child_frame_id"), mcap::Value(std::string("kl1")));
  EXPECT_EQ(number("pose.pose.position.x"), 2.0);
  EXPECT_NEAR(std::abs(number("pose.pose.orientation.w")), 1.0, 1e-12);
  EXPECT_NEAR(number("pose.covariance[0]"), 0.04, 1e-12) << "of the east";
  EXPECT_NEAR(number("pose.covariance[7]"), 0.01, 1e-12) << "of the north";
  EXPECT_NEAR(number("twist.twist.linear.x"), 0.25, 1e-12) << "forward: east";
  EXPECT_NEAR(number("twist.twist.linear.y"), 0.5, 1e-12) << "left: north";
  EXPECT_NEAR(number("twist.twist.linear.z"), 0.125, 1e-12);
  EXPECT_EQ(number("twist.twist.angular.z"), -0.3);
  EXPECT_NEAR(number("twist.covariance[14]"), 0.16, 1e-12);
  EXPECT_EQ(first[3].topic, "/kl1/path");
  // The path follows each second, and keeps half a minute at 10 Hz.
  std::vector<record::StandardMessage> last;
  std::size_t paths = 0;
  for (int i = 1; i <= 6000; ++i) {
    last = following(standard, "estimate", estimate, 5'000'000'007 + i * std::int64_t{10'000'000});
    paths += last.size() == 4 ? 1 : 0;
  }
  EXPECT_EQ(paths, 60U);
  EXPECT_EQ(decoded(last[3]).at("poses.length"), mcap::Value(std::uint64_t{301}));
}

TEST(StandardMessages, OfImuAndBatteryAreInFluAndSi) {
  record::StandardMessages standard("kl1");
  const auto imu = following(standard, "imu", messages::to_message(messages::fixtures::imu_sample()), 1);
  ASSERT_EQ(imu.size(), 1U);
  const auto values = decoded(imu.front());
  EXPECT_EQ(values.at("header.frame_id"), mcap::Value(std::string("kl1")));
  EXPECT_EQ(values.at("linear_acceleration.z"), mcap::Value(9.8));
  EXPECT_EQ(values.at("angular_velocity.x"), mcap::Value(0.3));
  EXPECT_EQ(values.at("angular_velocity.y"), mcap::Value(0.4));
  EXPECT_EQ(values.at("orientation_covariance[0]"), mcap::Value(-1.0));
  const auto battery =
      following(standard, "battery", messages::to_message(messages::fixtures::battery_sample()), 1);
  ASSERT_EQ(battery.size(), 1U);
  EXPECT_EQ(decoded(battery.front()).at("percentage"), mcap::Value(0.75));
  EXPECT_EQ(decoded(battery.front()).at("current"), mcap::Value(-2.5));
  EXPECT_TRUE(
      following(standard, "rotor_speeds", messages::to_message(messages::fixtures::rotor_speed_sample()), 1)
          .empty());
}

TEST(StandardMessages, OfEventsAreLinesOfALog) {
  record::StandardMessages standard("kl1");
  const auto line_of = [](const std::vector<record::StandardMessage>& messages) {
    return messages.size() == 1 ? std::get<std::string>(decoded(messages[0]).at("message")) : "";
  };
  messages::msg::ControlStatus status;
  status.mode(static_cast<std::uint8_t>(4));
  status.reason() = "mission started";
  const auto first = following(standard, "control_status", status, 3'000'000'001);
  ASSERT_EQ(first.size(), 1U);
  EXPECT_EQ(first[0].topic, "/kl1/log");
  EXPECT_EQ(decoded(first[0]).at("name"), mcap::Value(std::string("kl1/control")));
  EXPECT_EQ(decoded(first[0]).at("timestamp.nanosec"), mcap::Value(std::uint64_t{1}));
  EXPECT_NE(line_of(first).find(": mission started"), std::string::npos) << line_of(first);
  EXPECT_TRUE(following(standard, "control_status", status, 4'000'000'000).empty()) << "nothing new";
  messages::msg::CommandAck ack;
  ack.reason() = "not armed";
  EXPECT_EQ(line_of(following(standard, "command_ack", ack, 5)), "request refused: not armed");
  messages::msg::VehicleInfo info;
  EXPECT_TRUE(following(standard, "vehicle_info", info, 6).empty());
  info.rotors_running(true);
  EXPECT_EQ(line_of(following(standard, "vehicle_info", info, 7)), "rotors started");
  info.fault() = "no command for 0.1 s";
  const auto fault = following(standard, "vehicle_info", info, 8);
  EXPECT_EQ(line_of(fault), "no command for 0.1 s");
  EXPECT_EQ(decoded(fault[0]).at("level"), mcap::Value(std::uint64_t{4}));
  messages::msg::MissionStatus mission;
  EXPECT_TRUE(following(standard, "mission_status", mission, 9).empty()) << "none yet";
  mission.state(messages::msg::MissionStatus_Constants::ABORTED);
  mission.reason() = "pilot";
  EXPECT_EQ(line_of(following(standard, "mission_status", mission, 10)), "mission aborted: pilot");
}

TEST(StandardMessages, OfBytesThatAreNoMessageAreNone) {
  record::StandardMessages standard("kl1");
  const std::string bytes = "no message";
  for (const char* topic : {"estimate", "reference", "imu", "battery", "control_status", "mission_status",
                            "command_ack", "vehicle_info"})
    EXPECT_TRUE(standard.of(topic, sample(0, bytes)).empty()) << topic;
}

}  // namespace swiftlet::record::recording_test

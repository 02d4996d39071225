#include "swiftlet/services/control/vehicle_sample.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/services/messages/messages.hpp"

namespace swiftlet::services::vehicle_sample_test {

constexpr std::int64_t kSecond = 1'000'000'000;

TEST(VehicleSample, HasWhatTheMessagesShare) {
  messages::msg::VehicleOdometry message = messages::fixtures::example<messages::msg::VehicleOdometry>();
  message.lockstep().battery(4);
  message.obeyed(messages::to_message(plant::ObeyedCommand{true, true, 7, 99}));
  const VehicleSample sample = vehicle_sample(message);
  EXPECT_EQ(sample.stamp_ns(), message.stamp_ns());
  EXPECT_EQ(sample.sequence(), message.sequence_number());
  EXPECT_EQ(sample.lockstep.battery, 4U);
  EXPECT_EQ(sample.obeyed.term, 7U);
  EXPECT_TRUE(std::get<plant::OdometrySample>(sample.motion).position_valid);
}

TEST(VehicleSample, AnInvalidMessageIsNotFinite) {
  messages::msg::VehicleOdometry message = messages::fixtures::example<messages::msg::VehicleOdometry>();
  message.q_ned_from_frd({0.0, 0.0, 0.0, 0.0});
  const VehicleSample sample = vehicle_sample(message);
  EXPECT_EQ(sample.stamp_ns(), message.stamp_ns());
  EXPECT_FALSE(std::get<plant::OdometrySample>(sample.motion).body_rates_frd.allFinite());
}

// GIVEN a vehicle that sends both WHEN one was heard first THEN the other is ignored and named until the first is silent.
TEST(AnsweredSamples, AreOfOneKind) {
  using Kind = AnsweredSamples::Kind;
  AnsweredSamples answered;
  EXPECT_TRUE(answered.admit(Kind::kOdometry, 10 * kSecond));
  EXPECT_EQ(answered.ignored(10 * kSecond), nullptr);
  EXPECT_FALSE(answered.admit(Kind::kImu, 10 * kSecond + 1));
  EXPECT_EQ(std::string(answered.ignored(10 * kSecond + 2)), "imu");
  EXPECT_TRUE(answered.admit(Kind::kOdometry, 10 * kSecond + 3));
  EXPECT_TRUE(answered.admit(Kind::kImu, 12 * kSecond)) << "the other was silent";
  EXPECT_FALSE(answered.admit(Kind::kOdometry, 12 * kSecond + 1));
  EXPECT_EQ(std::string(answered.ignored(12 * kSecond + 2)), "vehicle_odometry");
}

}  // namespace swiftlet::services::vehicle_sample_test

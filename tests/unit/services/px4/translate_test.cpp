#include "swiftlet/services/px4/translate.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/vehicle_file.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::px4::translate_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const plant::Vehicle& kaylion() {
  static const plant::Vehicle vehicle = io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml"));
  return vehicle;
}

bool all_unused(const std::array<float, 3>& values) {
  return std::isnan(values[0]) && std::isnan(values[1]) && std::isnan(values[2]);
}

TEST(Px4Translate, RatesKeepTheirAxesAndThrustPointsUp) {
  const ThrustScale scale(kaylion());
  plant::RatesSetpoint setpoint;
  setpoint.body_rates_frd = {0.1, -0.2, 0.3};
  setpoint.thrust_n = kaylion().mass_kg * plant::kGravity;
  const msg::VehicleRatesSetpoint message = to_px4(setpoint, scale);
  EXPECT_EQ(message.timestamp(), 0U) << "now";
  EXPECT_FLOAT_EQ(message.roll(), 0.1F);
  EXPECT_FLOAT_EQ(message.pitch(), -0.2F);
  EXPECT_FLOAT_EQ(message.yaw(), 0.3F);
  EXPECT_EQ(message.thrust_body()[0], 0.0F);
  EXPECT_EQ(message.thrust_body()[1], 0.0F);
  EXPECT_FLOAT_EQ(message.thrust_body()[2], -static_cast<float>(scale.hover_throttle()));
}

TEST(Px4Translate, AttitudeKeepsItsFrame) {
  const ThrustScale scale(kaylion());
  plant::AttitudeSetpoint setpoint;
  setpoint.q_ned_from_frd = Quaterniond(Eigen::AngleAxisd(0.5, Vector3d::UnitZ()));
  setpoint.q_ned_from_frd.coeffs() *= -1.0;
  setpoint.body_rates_frd = {1.0, 2.0, 0.25};
  const msg::VehicleAttitudeSetpoint message = to_px4(setpoint, scale);
  EXPECT_FLOAT_EQ(message.q_d()[0], static_cast<float>(std::cos(0.25))) << "w is not negative";
  EXPECT_FLOAT_EQ(message.q_d()[3], static_cast<float>(std::sin(0.25)));
  EXPECT_FLOAT_EQ(message.yaw_sp_move_rate(), 0.25F);
  EXPECT_EQ(message.thrust_body()[2], 0.0F);
}

TEST(Px4Translate, UnusedFieldsOfATrajectoryAreNan) {
  plant::TrajectorySetpoint setpoint;
  setpoint.position_ned = {1.0, 2.0, -3.0};
  setpoint.velocity_ned = {0.1, 0.2, 0.3};
  setpoint.yaw_rad = 0.7;
  EXPECT_TRUE(all_unused(to_px4(setpoint).position())) << "position_used is false";
  EXPECT_FALSE(offboard_mode(setpoint).position());
  EXPECT_TRUE(offboard_mode(setpoint).velocity());
  setpoint.position_used = true;
  const msg::TrajectorySetpoint message = to_px4(setpoint);
  EXPECT_EQ(message.position(), (std::array<float, 3>{1.0F, 2.0F, -3.0F}));
  EXPECT_EQ(message.velocity(), (std::array<float, 3>{0.1F, 0.2F, 0.3F}));
  EXPECT_TRUE(all_unused(message.jerk()));
  EXPECT_FLOAT_EQ(message.yaw(), 0.7F);
  EXPECT_TRUE(offboard_mode(setpoint).position());
}

TEST(Px4Translate, TheModeNamesTheLevel) {
  EXPECT_TRUE(offboard_mode(plant::RatesSetpoint()).body_rate());
  EXPECT_FALSE(offboard_mode(plant::RatesSetpoint()).attitude());
  EXPECT_TRUE(offboard_mode(plant::AttitudeSetpoint()).attitude());
  EXPECT_FALSE(offboard_mode(plant::AttitudeSetpoint()).velocity());
}

TEST(Px4Translate, PosesHaveFrameVarianceAndResetCounter) {
  plant::PoseSample pose;
  pose.tracked = true;
  pose.position_ned = {1.0, 2.0, -3.0};
  const msg::VehicleOdometry message = to_px4(pose, {0.01, 0.1}, 7, 123);
  EXPECT_EQ(message.pose_frame(), 1) << "NED";
  EXPECT_EQ(message.position(), (std::array<float, 3>{1.0F, 2.0F, -3.0F}));
  EXPECT_FLOAT_EQ(message.position_variance()[2], 1e-4F);
  EXPECT_FLOAT_EQ(message.orientation_variance()[0], 1e-2F);
  EXPECT_TRUE(all_unused(message.velocity()));
  EXPECT_TRUE(all_unused(message.angular_velocity()));
  EXPECT_EQ(message.reset_counter(), 7);
  EXPECT_EQ(message.timestamp_sample(), 123U);
}

TEST(Px4Translate, CommandsAreExternalAndAnswersAreKnown) {
  const msg::VehicleCommand command = disarm_at_once(3);
  EXPECT_EQ(command.command(), 400U);
  EXPECT_EQ(command.param1(), 0.0F);
  EXPECT_EQ(command.param2(), 21196.0F);
  EXPECT_EQ(command.target_system(), 3);
  EXPECT_TRUE(command.from_external());
  msg::VehicleCommandAck ack;
  ack.target_system(command.source_system());
  ack.target_component(command.source_component());
  EXPECT_TRUE(is_for_us(ack));
  ack.target_component(190);
  EXPECT_FALSE(is_for_us(ack)) << "of a ground station";
}

TEST(Px4Translate, ItsEstimateHasWhatItKnows) {
  constexpr float kUnknown = std::numeric_limits<float>::quiet_NaN();
  msg::VehicleOdometry message;
  message.pose_frame(1);
  message.velocity_frame(1);
  message.position({1.0F, 2.0F, -3.0F});
  message.q({0.0F, 0.0F, 0.0F, 1.0F});
  message.velocity({kUnknown, kUnknown, kUnknown});
  message.angular_velocity({0.5F, 0.25F, -0.5F});
  message.position_variance({0.25F, 0.25F, 1.0F});
  message.velocity_variance({kUnknown, kUnknown, kUnknown});
  message.reset_counter(255);
  plant::OdometrySample estimate;
  ASSERT_FALSE(from_px4(message, estimate));
  EXPECT_TRUE(estimate.position_valid);
  EXPECT_EQ(estimate.position_ned, Eigen::Vector3d(1.0, 2.0, -3.0));
  EXPECT_FALSE(estimate.velocity_valid);
  EXPECT_EQ(estimate.body_rates_frd, Eigen::Vector3d(0.5, 0.25, -0.5));
  EXPECT_EQ(estimate.position_deviation, Eigen::Vector3d(0.5, 0.5, 1.0));
  EXPECT_EQ(estimate.velocity_deviation, Eigen::Vector3d(0.0, 0.0, 0.0));
  EXPECT_EQ(estimate.resets, 255U);
  message.reset_counter(1);
  message.velocity({0.1F, 0.2F, 0.3F});
  ASSERT_FALSE(from_px4(message, estimate));
  EXPECT_EQ(estimate.resets, 257U) << "the counter wraps";
  EXPECT_TRUE(estimate.velocity_valid);
}

// PX4 has the variances of the orientation about the body's axes; position and velocity have theirs in the frame.
TEST(Px4Translate, ItsOrientationVarianceIsTurnedIntoTheFrame) {
  msg::VehicleOdometry message;
  message.pose_frame(1);
  message.velocity_frame(1);
  message.position_variance({0.25F, 1.0F, 4.0F});
  message.velocity_variance({0.25F, 1.0F, 4.0F});
  message.orientation_variance({0.01F, 0.04F, 0.09F});
  const auto half = static_cast<float>(std::sqrt(0.5));
  message.q({half, 0.0F, 0.0F, half});  // forward is east
  plant::OdometrySample estimate;
  ASSERT_FALSE(from_px4(message, estimate));
  EXPECT_LT((estimate.rotation_deviation - Vector3d(0.2, 0.1, 0.3)).norm(), 1e-6);
  EXPECT_LT((estimate.position_deviation - Vector3d(0.5, 1.0, 2.0)).norm(), 1e-6);
  EXPECT_LT((estimate.velocity_deviation - Vector3d(0.5, 1.0, 2.0)).norm(), 1e-6);
  message.q({half, half, 0.0F, 0.0F});  // on its right side: right is down
  ASSERT_FALSE(from_px4(message, estimate));
  EXPECT_LT((estimate.rotation_deviation - Vector3d(0.1, 0.3, 0.2)).norm(), 1e-6);
}

// A layout that has changed shows as values that cannot be.
TEST(Px4Translate, NonsenseIsRefusedByName) {
  msg::SensorCombined sensors;
  plant::ImuSample imu;
  sensors.accelerometer_m_s2({0.0F, 0.0F, 1e9F});
  EXPECT_STREQ(from_px4(sensors, imu).text, "accelerometer_m_s2 is 1e+09, must be between -400 and 400");
  sensors.accelerometer_m_s2({0.0F, 0.0F, -9.8F});
  sensors.gyro_rad({0.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F});
  EXPECT_TRUE(from_px4(sensors, imu));
  sensors.gyro_rad({0.1F, 0.2F, 0.3F});
  EXPECT_FALSE(from_px4(sensors, imu));
  EXPECT_NEAR(imu.specific_force_frd.z(), -9.8, 1e-6);

  msg::VehicleOdometry odometry;
  plant::OdometrySample estimate;
  odometry.q({1.0F, 0.0F, 0.0F, 0.0F});
  EXPECT_STREQ(from_px4(odometry, estimate).text, "pose_frame is 0, must be between 1 and 1") << "unknown";
  odometry.pose_frame(1);
  odometry.position({0.0F, 3e7F, 0.0F});
  EXPECT_STREQ(from_px4(odometry, estimate).text, "position is 3e+07, must be between -100000 and 100000");
  odometry.position({0.0F, 0.0F, 0.0F});
  odometry.pose_frame(2);
  EXPECT_STREQ(from_px4(odometry, estimate).text, "pose_frame is 2, must be between 1 and 1") << "FRD";

  msg::BatteryStatus battery;
  battery.voltage_v(1e12F);
  plant::BatterySample sample;
  EXPECT_TRUE(from_px4(battery, sample));
  msg::VehicleStatus status;
  EXPECT_TRUE(check(status)) << "arming_state 0";
}

}  // namespace swiftlet::px4::translate_test

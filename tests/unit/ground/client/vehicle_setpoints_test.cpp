// Conversion of the client's setpoints to those that are sent.
#include "swiftlet/ground/client/vehicle_setpoints.hpp"

#include <gtest/gtest.h>

namespace swiftlet::ground::vehicle_setpoints_test {

using control::Setpoint;
using control::SetpointKind;
using Eigen::Vector3d;

TEST(VehicleSetpoints, PositionKeepsTheYawUnlessGiven) {
  const Setpoint yaw_kept = to_setpoint(PositionSetpoint{{1, 2, -3}, {0.1, 0.2, 0.3}, {4, 5, 6}});
  EXPECT_EQ(yaw_kept.kind, SetpointKind::kPosition);
  EXPECT_EQ(yaw_kept.position_ned, Vector3d(1, 2, -3));
  EXPECT_EQ(yaw_kept.velocity_ned, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(yaw_kept.acceleration_ned, Vector3d(4, 5, 6));
  EXPECT_TRUE(yaw_kept.yaw_free);
  const Setpoint with_yaw = to_setpoint(PositionSetpoint{{1, 2, -3}, {0, 0, 0}, {0, 0, 0}, {0.7, 0.2}});
  EXPECT_FALSE(with_yaw.yaw_free);
  EXPECT_EQ(with_yaw.yaw_rad, 0.7);
  EXPECT_EQ(with_yaw.yaw_rate, 0.2);
}

TEST(VehicleSetpoints, VelocityAndAccelerationAreConverted) {
  const Setpoint velocity = to_setpoint(VelocitySetpoint{{0.1, 0.2, 0.3}, {4, 5, 6}, {-1.5}});
  EXPECT_EQ(velocity.kind, SetpointKind::kVelocity);
  EXPECT_EQ(velocity.velocity_ned, Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(velocity.acceleration_ned, Vector3d(4, 5, 6));
  EXPECT_EQ(velocity.yaw_rad, -1.5);
  const Setpoint acceleration = to_setpoint(AccelerationSetpoint{{4, 5, 6}, {std::nullopt, 0.3}});
  EXPECT_EQ(acceleration.kind, SetpointKind::kAcceleration);
  EXPECT_EQ(acceleration.acceleration_ned, Vector3d(4, 5, 6));
  EXPECT_TRUE(acceleration.yaw_free);
  EXPECT_EQ(acceleration.yaw_rate, 0.3);
}

TEST(VehicleSetpoints, AttitudeAndBodyRatesHaveThrust) {
  const Eigen::Quaterniond tilted(0.5, 0.5, -0.5, 0.5);
  const Setpoint attitude = to_setpoint(AttitudeSetpoint{tilted, 9.81, {0.1, 0.2, 0.3}});
  EXPECT_EQ(attitude.kind, SetpointKind::kAttitude);
  EXPECT_EQ(attitude.q_ned_from_frd.coeffs(), tilted.coeffs());
  EXPECT_EQ(attitude.specific_thrust, 9.81);
  EXPECT_EQ(attitude.body_rates_frd, Vector3d(0.1, 0.2, 0.3));
  const Setpoint rates = to_setpoint(BodyRatesSetpoint{{1, 2, 3}, 8.0});
  EXPECT_EQ(rates.kind, SetpointKind::kBodyRates);
  EXPECT_EQ(rates.body_rates_frd, Vector3d(1, 2, 3));
  EXPECT_EQ(rates.specific_thrust, 8.0);
}

}  // namespace swiftlet::ground::vehicle_setpoints_test

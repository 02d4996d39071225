#include "swiftlet/control/estimation/odometry_motion.hpp"

#include <gtest/gtest.h>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::odometry_motion_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

plant::OdometrySample sample(std::int64_t stamp_ns, const Vector3d& velocity_ned,
                             const Quaterniond& q = Quaterniond::Identity()) {
  plant::OdometrySample sample;
  sample.stamp_ns = stamp_ns;
  sample.position_valid = sample.velocity_valid = true;
  sample.velocity_ned = velocity_ned;
  sample.q_ned_from_frd = q;
  return sample;
}

TEST(OdometryMotion, IsWhatAnImuWouldMeasure) {
  OdometryMotion motion;
  EXPECT_TRUE(motion.step(sample(0, {0.0, 0.0, 0.0}), 0.0)
                  .specific_force_frd.isApprox(Vector3d(0.0, 0.0, -plant::kGravity)))
      << "at rest";
  const MeanMotion north = motion.step(sample(10'000'000, {0.02, 0.0, 0.0}), 0.0);
  EXPECT_TRUE(north.specific_force_frd.isApprox(Vector3d(2.0, 0.0, -plant::kGravity), 1e-9)) << "2 m/s^2";
  const Quaterniond turned = math::rotation(Vector3d(0.0, 0.0, 0.01));
  const MeanMotion turning = motion.step(sample(20'000'000, {0.02, 0.0, 0.0}, turned), 0.0);
  EXPECT_NEAR(turning.body_rates_frd.z(), 1.0, 1e-9);
}

TEST(OdometryMotion, AJumpIsNone) {
  OdometryMotion motion;
  motion.step(sample(0, {0.0, 0.0, 0.0}), 0.0);
  const MeanMotion before = motion.step(sample(10'000'000, {0.01, 0.0, 0.0}), 0.0);
  plant::OdometrySample jumped =
      sample(20'000'000, {-3.0, 2.0, 1.0}, math::rotation(Vector3d(0.0, 0.0, 1.0)));
  jumped.resets = 1;
  const MeanMotion after = motion.step(jumped, 0.0);
  EXPECT_EQ(after.specific_force_frd, before.specific_force_frd);
  EXPECT_EQ(after.body_rates_frd, Vector3d(0.0, 0.0, 0.0));
  jumped.stamp_ns = 30'000'000;
  EXPECT_NEAR(motion.step(jumped, 0.0).specific_force_frd.norm(), plant::kGravity, 1e-9) << "it goes on";
}

// GIVEN stamps of a clock that is set WHEN one follows the last closely THEN the change of velocity is no impact.
TEST(OdometryMotion, AStampThatIsTooCloseIsNoForce) {
  OdometryMotion motion;
  double north = 0.0;
  for (int i = 0; i < 10; ++i) motion.step(sample(i * 10'000'000, {north += 0.02, 0.0, 0.0}), 0.0);
  const MeanMotion close = motion.step(sample(90'000'001, {north += 0.02, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(close.specific_force_frd.x(), 2.0, 1e-9);
  const MeanMotion next = motion.step(sample(110'000'000, {north += 0.02, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(next.specific_force_frd.x(), 2.0, 1e-9) << "since the sample before";
}

TEST(OdometryMotion, WithoutVelocityIsTheThrust) {
  OdometryMotion motion;
  plant::OdometrySample blind = sample(0, {0.0, 0.0, 0.0});
  blind.velocity_valid = false;
  motion.step(blind, 0.0);
  blind.stamp_ns = 10'000'000;
  EXPECT_EQ(motion.step(blind, 8.0).specific_force_frd, Vector3d(0.0, 0.0, -8.0));
  blind.stamp_ns = 20'000'000;
  EXPECT_TRUE(motion.step(blind, 2.0).specific_force_frd.isApprox(Vector3d(0.0, 0.0, -plant::kGravity)))
      << "the ground carries it";
}

}  // namespace swiftlet::control::odometry_motion_test

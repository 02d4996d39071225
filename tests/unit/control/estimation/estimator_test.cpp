#include "swiftlet/control/estimation/estimator.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/control/estimation/estimator_motion.hpp"

namespace swiftlet::control::estimator_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

double angle_between(const Quaterniond& a, const Quaterniond& b) { return a.angularDistance(b); }

// Runs to `end_s` with poses that arrive `latency_ns` after their exposure.
void run(Estimator& estimator, const Motion& motion, double end_s, std::int64_t latency_ns) {
  std::uint64_t sequence = 0;
  for (std::int64_t t = kStep_ns; static_cast<double>(t) * 1e-9 <= end_s; t += kStep_ns) {
    ASSERT_TRUE(estimator.predict(motion.imu(t)));
    const std::int64_t exposed = t - latency_ns;
    if (exposed > 0 && exposed % kFrame_ns == 0) estimator.correct(Motion::pose(exposed, ++sequence));
  }
}

class EstimatorLatency : public testing::TestWithParam<int> {};

TEST_P(EstimatorLatency, FollowsTheMotionAtAnyPoseLatency) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  run(estimator, motion, 8.0, std::int64_t{GetParam()} * 1'000'000);
  const Estimate& e = estimator.estimate();
  const double t = static_cast<double>(e.stamp_ns) * 1e-9;
  EXPECT_LT((e.position_ned - Motion::position(t)).norm(), 2e-4);
  EXPECT_LT((e.velocity_ned - Motion::velocity(t)).norm(), 2e-3);
  EXPECT_LT(angle_between(e.q_ned_from_frd, Motion::attitude(t)), 1e-3);
}
INSTANTIATE_TEST_SUITE_P(Milliseconds, EstimatorLatency, testing::Values(0, 10, 30, 100));

// Between the stamp of a pose and its arrival the filter makes more corrections than it keeps.
TEST(Estimator, FollowsPosesAtTheImuRateATenthOfASecondLate) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  motion.gyro_bias = {0.02, -0.03, 0.01};
  motion.accelerometer_bias = {0.15, -0.1, 0.2};
  std::uint64_t sequence = 0;
  for (std::int64_t t = kStep_ns; t <= 6'000'000'000; t += kStep_ns) {
    ASSERT_TRUE(estimator.predict(motion.imu(t)));
    const std::int64_t exposed = t - 50 * kStep_ns;
    if (exposed <= 0) continue;
    estimator.correct(Motion::pose(exposed, ++sequence));
    if (t < 500'000'000) continue;
    const double s = static_cast<double>(t) * 1e-9;
    ASSERT_LT((estimator.estimate().position_ned - Motion::position(s)).norm(), 5e-3) << s;
    ASSERT_LT((estimator.estimate().velocity_ned - Motion::velocity(s)).norm(), 0.05) << s;
    ASSERT_LT(angle_between(estimator.estimate().q_ned_from_frd, Motion::attitude(s)), 0.01) << s;
  }
  EXPECT_EQ(estimator.estimate().poses_refused, 0U);
  EXPECT_LT((estimator.estimate().gyro_bias - motion.gyro_bias).norm(), 2e-3);
}

// A constant rate is integrated without error, however long the steps.
TEST(Estimator, IntegratesTheMeasuredRate) {
  for (const std::int64_t step_ns : {100'000, 1'000'000, 10'000'000, 100'000'000}) {
    Estimator estimator{EstimatorSettings{}};
    plant::ImuSample imu;
    imu.stamp_ns = 1;
    imu.body_rates_frd = {7.0, -20.0, 15.0};
    ASSERT_TRUE(estimator.predict(imu));
    ASSERT_TRUE(estimator.correct({1, 1, true, Vector3d::Zero(), Quaterniond::Identity()}));
    while (imu.stamp_ns < 300'000'000) {
      imu.stamp_ns += step_ns;
      ASSERT_TRUE(estimator.predict(imu));
    }
    const double angle = 0.3 * imu.body_rates_frd.norm();
    const Quaterniond expected(AngleAxisd(angle, imu.body_rates_frd.normalized()));
    EXPECT_LT(angle_between(estimator.estimate().q_ned_from_frd, expected), 1e-12) << step_ns;
  }
}

TEST(Estimator, EstimatesGyroAndAccelerometerBiases) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  motion.gyro_bias = {0.02, -0.03, 0.01};
  motion.accelerometer_bias = {0.15, -0.1, 0.2};
  run(estimator, motion, 12.0, 10'000'000);
  EXPECT_LT((estimator.estimate().gyro_bias - motion.gyro_bias).norm(), 2e-3);
  EXPECT_LT((estimator.estimate().accelerometer_bias - motion.accelerometer_bias).norm(), 2e-2);
  const double t = static_cast<double>(estimator.estimate().stamp_ns) * 1e-9;
  EXPECT_LT((estimator.estimate().velocity_ned - Motion::velocity(t)).norm(), 1e-2);
}

TEST(Estimator, DeadReckonsThroughHalfASecondWithoutPoses) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  motion.accelerometer_bias = {0.05, -0.05, 0.05};
  run(estimator, motion, 10.0, 10'000'000);
  for (int i = 0; i < 250; ++i) {
    ASSERT_TRUE(estimator.predict(motion.imu(estimator.estimate().stamp_ns + kStep_ns)));
  }
  const double t = static_cast<double>(estimator.estimate().stamp_ns) * 1e-9;
  EXPECT_LT((estimator.estimate().position_ned - Motion::position(t)).norm(), 0.02);
  EXPECT_NEAR(estimator.pose_age_s(), 0.51, 0.011);
}

TEST(Estimator, IsNotInitialisedBeforeTheFirstPose) {
  Estimator estimator{EstimatorSettings{}};
  EXPECT_TRUE(estimator.predict(Motion().imu(kStep_ns)));
  EXPECT_FALSE(estimator.initialised());
  EXPECT_TRUE(std::isinf(estimator.pose_age_s()));
}

TEST(Estimator, RefusesSamplesThatAreNotFiniteOrNotNewer) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  run(estimator, motion, 1.0, 0);
  const Estimate before = estimator.estimate();
  plant::ImuSample imu = motion.imu(before.stamp_ns + kStep_ns);
  imu.body_rates_frd.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(estimator.predict(imu));
  EXPECT_FALSE(estimator.predict(motion.imu(before.stamp_ns)));
  plant::PoseSample pose = Motion::pose(before.stamp_ns, 1000);
  EXPECT_FALSE(estimator.correct(pose));  // its stamp has been used
  pose = Motion::pose(before.stamp_ns + 1, 1001);
  pose.tracked = false;
  EXPECT_FALSE(estimator.correct(pose));
  pose.tracked = true;
  pose.position_ned.x() = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(estimator.correct(pose));
  pose = Motion::pose(before.stamp_ns + 1, 1001);
  pose.q_ned_from_frd.coeffs() *= 1.5;
  EXPECT_FALSE(estimator.correct(pose));
  EXPECT_EQ(estimator.estimate().position_ned, before.position_ned);
  EXPECT_EQ(estimator.estimate().stamp_ns, before.stamp_ns);
}

// Poses with an offset for a second. Returns how many were accepted.
int run_with_jump(Estimator& estimator, const Motion& motion, const Vector3d& offset_ned,
                  plant::RotorState rotors) {
  std::uint64_t sequence = 10'000;
  int accepted = 0;
  for (int frame = 0; frame < 100; ++frame) {
    for (int i = 0; i < 5; ++i) estimator.predict(motion.imu(estimator.estimate().stamp_ns + kStep_ns));
    plant::PoseSample pose = Motion::pose(estimator.estimate().stamp_ns, ++sequence);
    pose.position_ned += offset_ned;
    if (estimator.correct(pose, rotors)) ++accepted;
  }
  return accepted;
}

double position_error(const Estimator& estimator) {
  const double t = static_cast<double>(estimator.estimate().stamp_ns) * 1e-9;
  return (estimator.estimate().position_ned - Motion::position(t)).norm();
}

// In a gap of 10 s the estimator integrates 0.25 s with the last rates and specific force.
TEST(Estimator, DoesNotIntegrateThroughALongGap) {
  Estimator estimator{EstimatorSettings{}};
  plant::ImuSample imu;
  imu.specific_force_frd = {0.0, 0.0, -plant::kGravity};
  std::uint64_t sequence = 0;
  const auto fly_for = [&](std::int64_t duration_ns) {
    const std::int64_t end_ns = imu.stamp_ns + duration_ns;
    while (imu.stamp_ns < end_ns) {
      imu.stamp_ns += kStep_ns;
      ASSERT_TRUE(estimator.predict(imu));
      if (imu.stamp_ns % kFrame_ns != 0) continue;
      const double t = static_cast<double>(imu.stamp_ns) * 1e-9;
      ASSERT_TRUE(estimator.correct(
          {imu.stamp_ns, ++sequence, true, Vector3d(0.0, t, -1.0), Quaterniond::Identity()}));
    }
  };
  fly_for(2'000'000'000);  // east at 1 m/s
  const Estimate before = estimator.estimate();
  imu.stamp_ns += 10'000'000'000;
  imu.body_rates_frd.z() = 0.8;  // at the end of the gap; half as much in its mean
  ASSERT_TRUE(estimator.predict(imu));
  const Estimate& after = estimator.estimate();
  EXPECT_EQ(after.stamp_ns, imu.stamp_ns);
  EXPECT_LT((after.position_ned - before.position_ned - Vector3d(0.0, 0.25, 0.0)).norm(), 1e-3);
  EXPECT_LT((after.velocity_ned - before.velocity_ned).norm(), 1e-3);
  EXPECT_NEAR(angle_between(after.q_ned_from_frd, before.q_ned_from_frd), 0.25 * 0.4, 1e-3);
  EXPECT_GT(estimator.standard_deviation()[0], 10.0) << "the standard deviation must grow";
}

// Every second pose of the same motion is -q, the same attitude.
TEST(Estimator, IgnoresTheSignOfAPoseQuaternion) {
  Estimator one{EstimatorSettings{}};
  Estimator other{EstimatorSettings{}};
  const Motion motion;
  std::uint64_t sequence = 0;
  for (std::int64_t t = kStep_ns; t <= 5'000'000'000; t += kStep_ns) {
    ASSERT_TRUE(one.predict(motion.imu(t)));
    ASSERT_TRUE(other.predict(motion.imu(t)));
    if (t % kFrame_ns != 0) continue;
    plant::PoseSample pose = Motion::pose(t, ++sequence);
    ASSERT_TRUE(one.correct(pose));
    if (sequence % 2 == 0) pose.q_ned_from_frd.coeffs() *= -1.0;
    ASSERT_TRUE(other.correct(pose)) << to_string(other.estimate().pose_fault);
    ASSERT_LT((one.estimate().position_ned - other.estimate().position_ned).norm(), 1e-12);
    ASSERT_LT((one.estimate().velocity_ned - other.estimate().velocity_ned).norm(), 1e-12);
    ASSERT_LT(angle_between(one.estimate().q_ned_from_frd, other.estimate().q_ned_from_frd), 1e-7);
  }
}

// Another body or a shifted world frame: in flight the estimator relies on the IMU.
TEST(Estimator, RefusesAJumpInFlight) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  run(estimator, motion, 2.0, 0);
  EXPECT_EQ(run_with_jump(estimator, motion, {2.0, 0.0, 0.0}, plant::RotorState::kRunning), 0);
  EXPECT_LT(position_error(estimator), 0.05);
  EXPECT_EQ(run_with_jump(estimator, motion, {0.0, 0.0, 0.0}, plant::RotorState::kRunning), 100);
}

TEST(Estimator, AcceptsALastingJumpWithRotorsOff) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  run(estimator, motion, 2.0, 0);
  EXPECT_EQ(run_with_jump(estimator, motion, {2.0, 0.0, 0.0}, plant::RotorState::kOff), 100 - 20);
  EXPECT_EQ(estimator.estimate().resets, 1U);
  EXPECT_NEAR(position_error(estimator), 2.0, 0.01);
}

// The vehicle is carried away with yaw and tilt. The jump is a rotation in NED,
// q_new = rotation(jump) * q_old, not one in body axes.
TEST(Estimator, ReportsAJumpInNed) {
  Estimator estimator{EstimatorSettings{}};
  const Quaterniond stood =
      Quaterniond(AngleAxisd(1.2, Vector3d::UnitZ()) * AngleAxisd(0.2, Vector3d::UnitY()));
  const Vector3d jump_ned(0.0, 0.1, 0.5);
  const Quaterniond carried = Quaterniond(AngleAxisd(jump_ned.norm(), jump_ned.normalized())) * stood;
  std::uint64_t sequence = 0;
  const auto stand = [&](const Vector3d& at_ned, const Quaterniond& q) {
    plant::ImuSample imu;
    for (int i = 0; i < 500; ++i) {
      imu.stamp_ns = estimator.estimate().stamp_ns + kStep_ns;
      imu.specific_force_frd = q.conjugate() * Vector3d(0.0, 0.0, -plant::kGravity);
      estimator.predict(imu);
      if (i % 5 == 0) estimator.correct({imu.stamp_ns, ++sequence, true, at_ned, q}, plant::RotorState::kOff);
    }
  };
  stand({1.0, 2.0, 0.0}, stood);
  stand({1.5, 2.0, -0.3}, carried);
  ASSERT_EQ(estimator.estimate().resets, 1U);
  EXPECT_LT(angle_between(estimator.estimate().q_ned_from_frd, carried), 5e-3);
  EXPECT_LT((estimator.estimate().reset_rotation_ned - jump_ned).norm(), 0.03)
      << estimator.estimate().reset_rotation_ned.transpose();
  EXPECT_LT((estimator.estimate().reset_position_ned - Vector3d(0.5, 0.0, -0.3)).norm(), 0.2);
}

TEST(Estimator, FollowsThePosesWhenTheImuIsWrong) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  run(estimator, motion, 2.0, 0);
  Motion wrong = motion;
  wrong.accelerometer_bias = {20.0, 0.0, 0.0};
  EXPECT_EQ(run_with_jump(estimator, wrong, {0.0, 0.0, 0.0}, plant::RotorState::kRunning), 100);
  EXPECT_LT(position_error(estimator), 0.01);
  run_with_jump(estimator, motion, {0.0, 0.0, 0.0}, plant::RotorState::kRunning);
  EXPECT_LT(position_error(estimator), 0.005);
}

TEST(Estimator, RefusesAPoseOlderThanItsHistory) {
  Estimator estimator{EstimatorSettings{}};
  Motion motion;
  ASSERT_TRUE(estimator.predict(motion.imu(kStep_ns)));
  ASSERT_TRUE(estimator.correct(Motion::pose(kStep_ns, 1)));
  for (int i = 0; i < 2 * StateHistory::kCapacity; ++i)
    estimator.predict(motion.imu(estimator.estimate().stamp_ns + kStep_ns));
  EXPECT_FALSE(estimator.correct(Motion::pose(3 * kStep_ns, 2)));
}

}  // namespace swiftlet::control::estimator_test

// Poses against an IMU that is wrong or silent: which are followed, and which are refused.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/control/estimation/estimator_faults.hpp"

namespace swiftlet::control::estimator_imu_faults_test {

using Eigen::AngleAxisd;
using Eigen::Vector3d;
using plant::PoseSample;

// A shock that the accelerometer measures wrongly.
TEST_F(EstimatorFaults, FollowsPosesWhenTheImuIsWrong) {
  fly(3.0);
  imu_error_ = {60.0, 0.0, 0.0};
  EXPECT_EQ(fly(0.05), PoseFault::kNone);
  imu_error_.setZero();
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(position_error(), 0.005);
  EXPECT_LT(angle_error(), 0.02);
}

// The same with some poses missing: the difference exceeds any noise, but the stream is unbroken.
TEST_F(EstimatorFaults, FollowsAnUnbrokenStreamAgainstTheImu) {
  fly(3.0);
  imu_error_ = {40.0, 0.0, 0.0};
  fly(0.05, [](PoseSample& pose) { pose.tracked = false; });
  imu_error_.setZero();
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
  EXPECT_GE(estimator_.estimate().resets, 1U);
  EXPECT_LT(position_error(), 0.02);
  EXPECT_LT(angle_error(), 0.02);
}

// After 0.2 s without poses they differ by 8 cm from the IMU. A body could have moved there, but the stream
// was interrupted and the IMU was not: the IMU is followed.
TEST_F(EstimatorFaults, RefusesAnInterruptedStreamAgainstTheImu) {
  for (const Vector3d& off :
       {Vector3d(0.08, 0.0, 0.0), Vector3d(0.0, -0.08, 0.0), Vector3d(0.0, 0.0, 0.08)}) {
    estimator_ = Estimator(settings_);
    fly(3.0);
    fly(0.2, [](PoseSample& pose) { pose.tracked = false; });
    EXPECT_EQ(fly(0.5, [&](PoseSample& pose) { pose.position_ned += off; }), PoseFault::kOutlier);
    EXPECT_EQ(estimator_.estimate().resets, 0U);
    EXPECT_LT(position_error(), 0.06);
    EXPECT_EQ(fly(0.5), PoseFault::kNone);
    EXPECT_LT(position_error(), 2e-3);
  }
}

// An IMU silence ends with the next pose that agrees: it does not excuse a difference after a later gap.
TEST_F(EstimatorFaults, RefusesAnInterruptedStreamAfterAnEarlierImuSilence) {
  fly(3.0);
  time_ns_ += 50'000'000;
  EXPECT_EQ(fly(2.0), PoseFault::kNone);
  fly(0.2, [](PoseSample& pose) { pose.tracked = false; });
  EXPECT_EQ(fly(0.5, [](PoseSample& pose) { pose.position_ned.x() += 0.08; }), PoseFault::kOutlier);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(position_error(), 0.06);
}

// The vehicle may have hit the ground meanwhile: poses in reach of a body are accepted, others are not.
TEST_F(EstimatorFaults, AcceptsPosesInReachAfterImuSilence) {
  for (const double off : {0.5, 2.0}) {
    estimator_ = Estimator(settings_);
    fly(3.0);
    time_ns_ += 250'000'000;
    const PoseFault fault = fly(0.5, [&](PoseSample& pose) { pose.position_ned.x() += off; });
    const bool accepted = off < 1.0;
    EXPECT_EQ(fault, accepted ? PoseFault::kNone : PoseFault::kOutlier) << off;
    EXPECT_EQ(estimator_.estimate().resets, accepted ? 1U : 0U) << off;
    EXPECT_NEAR(position_error(), accepted ? off : 0.0, 0.2);
  }
}

// The step during the silence of the IMU shows that the poses after it are no motion.
TEST_F(EstimatorFaults, RefusesMarkersThatSwapDuringImuSilence) {
  const Change swap = [](PoseSample& pose) {
    pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(0.4 * M_PI, Vector3d::UnitZ());
  };
  fly(3.0);
  for (int frame = 1; frame <= 8; ++frame) {
    time_ns_ += kFrame_ns;
    PoseSample pose = motion_.pose(time_ns_ - kFrame_ns);
    if (frame > 6) swap(pose);
    estimator_.correct(pose);
  }
  EXPECT_EQ(fly(0.5, swap), PoseFault::kSwapped);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(angle_error(), 0.1);
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
}

// The rotation alone could be a motion during the silence.
TEST_F(EstimatorFaults, RefusesAPoseRotationDuringImuSilence) {
  const Change turned = [](PoseSample& pose) {
    pose.position_ned.x() += 0.03;
    pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(0.2, Vector3d(0.6, 0.8, 0.0));
  };
  for (const int last_true_frame : {0, 12, 23}) {
    estimator_ = Estimator(settings_);
    hidden_turn_.setIdentity();
    fly(3.0);
    hidden_turn_ = AngleAxisd(0.05, Vector3d(0.8, -0.6, 0.0));
    for (int frame = 1; frame <= 24; ++frame) {
      time_ns_ += kFrame_ns;
      PoseSample pose = pose_now();
      if (frame > last_true_frame) turned(pose);
      estimator_.correct(pose);
    }
    EXPECT_EQ(fly(0.4, turned), PoseFault::kOutlier) << last_true_frame;
    EXPECT_LT(angle_error(), 0.1) << last_true_frame;
    // Poses that step back into reach are accepted again, though the IMU has missed a motion.
    EXPECT_EQ(fly(0.2), PoseFault::kNone) << last_true_frame;
    EXPECT_EQ(fly(0.5), PoseFault::kNone) << last_true_frame;
    EXPECT_LT(position_error(), 2e-3) << last_true_frame;
    EXPECT_LT(angle_error(), 0.005) << last_true_frame;
  }
}

// Poses are missing as well, so that no step is visible: they contradict the IMU afterwards.
TEST_F(EstimatorFaults, RefusesAPoseRotationHiddenByImuSilence) {
  for (const double angle : {0.1, 0.2, 0.4}) {
    const Change turned = [&](PoseSample& pose) {
      pose.position_ned.x() += 0.03;
      pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(angle, Vector3d(0.6, 0.8, 0.0));
    };
    estimator_ = Estimator(settings_);
    hidden_turn_.setIdentity();
    fly(3.0);
    hidden_turn_ = AngleAxisd(0.05, Vector3d(0.8, -0.6, 0.0));
    time_ns_ += 250'000'000;
    fly(1.0, turned);
    EXPECT_GT(estimator_.pose_age_s(), 1.0) << angle;
    EXPECT_LT(angle_error(), 0.1) << angle;
    EXPECT_EQ(fly(0.2), PoseFault::kNone) << angle;
    EXPECT_EQ(fly(0.5), PoseFault::kNone) << angle;
    EXPECT_LT(position_error(), 2e-3) << angle;
    EXPECT_LT(angle_error(), 0.005) << angle;
  }
}

// A real motion during the silence is accepted as soon as the IMU confirms it.
TEST_F(EstimatorFaults, AcceptsAMotionHiddenByImuSilence) {
  fly(3.0);
  hidden_turn_ = AngleAxisd(0.2, Vector3d(0.6, 0.8, 0.0));
  time_ns_ += 200'000'000;
  EXPECT_EQ(fly(0.1), PoseFault::kOutlier) << "until the consistency test agrees";
  EXPECT_EQ(fly(0.1), PoseFault::kNone);
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
  EXPECT_LT(angle_error(), 0.005);
  EXPECT_LT(position_error(), 2e-3);
}

}  // namespace swiftlet::control::estimator_imu_faults_test

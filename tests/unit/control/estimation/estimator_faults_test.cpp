// Faulty poses: which are refused, with which fault, and when the estimate is reset.
#include <cmath>
#include <cstdint>
#include <functional>
#include <tuple>

#include <gtest/gtest.h>

#include "swiftlet/control/estimation/estimator.hpp"
#include "tests/unit/control/estimation/estimator_motion.hpp"

namespace swiftlet::control::estimator_faults_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::PoseSample;
using plant::RotorState;

// Poses at 100 Hz, 10 ms late, from a moving vehicle.
class EstimatorFaults : public testing::Test {
 protected:
  using Change = std::function<void(PoseSample&)>;

  // Returns the fault of the last pose.
  PoseFault fly(
      double duration_s, const Change& change = [](PoseSample&) {},
      RotorState rotors = RotorState::kRunning) {
    const std::int64_t end = time_ns_ + static_cast<std::int64_t>(duration_s * 1e9);
    while (time_ns_ < end) {
      time_ns_ += kStep_ns;
      plant::ImuSample imu = motion_.imu(time_ns_);
      imu.specific_force_frd = hidden_turn_.conjugate() * imu.specific_force_frd + imu_error_;
      imu.body_rates_frd = hidden_turn_.conjugate() * imu.body_rates_frd;
      EXPECT_TRUE(estimator_.predict(imu));
      if (time_ns_ % kFrame_ns != 0 || time_ns_ < 2 * kFrame_ns) continue;
      PoseSample pose = pose_now();
      change(pose);
      estimator_.correct(pose, rotors);
    }
    return estimator_.estimate().pose_fault;
  }
  PoseSample pose_now() {
    PoseSample pose = motion_.pose(time_ns_ - kFrame_ns);
    pose.q_ned_from_frd = pose.q_ned_from_frd * hidden_turn_;
    return pose;
  }
  double position_error() const { return motion_.error(estimator_.estimate()).head<3>().norm(); }
  double velocity_error() const { return motion_.error(estimator_.estimate()).segment<3>(3).norm(); }
  double accelerometer_bias_error() const { return motion_.error(estimator_.estimate()).tail<3>().norm(); }
  double angle_error() const {
    const double t = static_cast<double>(estimator_.estimate().stamp_ns) * 1e-9;
    return (Motion::attitude(t) * hidden_turn_).angularDistance(estimator_.estimate().q_ned_from_frd);
  }

  EstimatorSettings settings_;
  Estimator estimator_{settings_};
  NoisyMotion motion_{settings_, 1};
  Vector3d imu_error_ = Vector3d::Zero();              // m/s^2
  Quaterniond hidden_turn_ = Quaterniond::Identity();  // of the body, in no IMU sample
  std::int64_t time_ns_ = 0;
};

TEST_F(EstimatorFaults, AcceptsEveryGoodPose) {
  EXPECT_EQ(fly(20.0), PoseFault::kNone);
  EXPECT_EQ(estimator_.estimate().poses_refused, 0U);
  EXPECT_EQ(estimator_.estimate().poses_accepted, 1999U);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
}

TEST_F(EstimatorFaults, RefusesSingleOutliersWithoutAnError) {
  fly(2.0);
  for (int i = 0; i < 50; ++i) {
    const double angle = 2.4 * i;
    const Vector3d away(std::cos(angle), std::sin(angle), 0.3);
    EXPECT_EQ(fly(0.01, [&](PoseSample& pose) { pose.position_ned += (0.06 + 0.05 * i) * away; }),
              PoseFault::kOutlier);
    EXPECT_EQ(fly(0.03), PoseFault::kNone);
    EXPECT_LT(position_error(), 5e-4);
  }
  EXPECT_EQ(estimator_.estimate().poses_refused, 50U);
}

// Below the threshold of an outlier, the gate limits how far a pose moves the estimate.
TEST_F(EstimatorFaults, SmallJumpMovesTheEstimateLittle) {
  fly(2.0);
  EXPECT_EQ(fly(0.01, [](PoseSample& pose) { pose.position_ned.x() += 0.04; }), PoseFault::kNone);
  EXPECT_LT(position_error(), 1e-3);
  EXPECT_EQ(fly(1.0), PoseFault::kNone);
  EXPECT_LT(position_error(), 5e-4);
}

TEST_F(EstimatorFaults, ScatteredOutliersNeverMoveTheEstimate) {
  fly(2.0);
  int i = 0;
  fly(0.4, [&](PoseSample& pose) { pose.position_ned.x() += ++i % 2 == 0 ? 1.0 : -0.5; });
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(position_error(), 0.02);
}

TEST_F(EstimatorFaults, RefusesALastingJumpInFlight) {
  fly(3.0);
  const Change jumped = [](PoseSample& pose) { pose.position_ned += Vector3d(1.0, -0.4, 0.2); };
  EXPECT_EQ(fly(1.0, jumped), PoseFault::kOutlier);
  EXPECT_LT(position_error(), 0.2) << "it uses the IMU alone";
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
  EXPECT_LT(position_error(), 5e-3);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
}

// A step below the threshold of an outlier is followed, but must leave no velocity for later dead reckoning.
TEST_F(EstimatorFaults, SmallLastingStepLeavesNoVelocity) {
  fly(3.0);
  const Change stepped = [](PoseSample& pose) { pose.position_ned.x() += 0.045; };
  for (const Change& change : {stepped, Change([](PoseSample&) {})}) {
    EXPECT_EQ(fly(0.1, change), PoseFault::kNone);
    EXPECT_LT(velocity_error(), 0.05);
    EXPECT_EQ(fly(1.0, change), PoseFault::kNone);
    EXPECT_LT(velocity_error(), 0.01);
    EXPECT_LT(accelerometer_bias_error(), 0.05);
  }
  EXPECT_LT(position_error(), 5e-4);
}

// With a wrong tilt, dead reckoning would diverge.
TEST_F(EstimatorFaults, RefusesAnAttitudeJumpInFlight) {
  fly(3.0);
  const Change turned = [](PoseSample& pose) {
    pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(0.08, Vector3d::UnitY());
  };
  EXPECT_EQ(fly(0.5, turned), PoseFault::kOutlier);
  EXPECT_LT(angle_error(), 0.01);
  EXPECT_EQ(fly(0.5), PoseFault::kNone);
  EXPECT_LT(angle_error(), 0.005);
}

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

TEST_F(EstimatorFaults, RefusesSwappedMarkersInFlight) {
  fly(2.0);
  for (const double angle : {0.5 * M_PI, M_PI}) {
    EXPECT_EQ(fly(0.5,
                  [&](PoseSample& pose) {
                    pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(angle, Vector3d::UnitZ());
                  }),
              PoseFault::kSwapped);
    EXPECT_LT(angle_error(), 0.01);
    EXPECT_EQ(fly(0.5), PoseFault::kNone);
  }
  EXPECT_EQ(estimator_.estimate().resets, 0U);
}

TEST_F(EstimatorFaults, AcceptsSwappedMarkersWithRotorsOff) {
  const Change turned = [](PoseSample& pose) {
    pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(M_PI, Vector3d::UnitZ());
  };
  fly(1.0, turned, RotorState::kOff);
  EXPECT_GT(angle_error(), 3.0);
  EXPECT_EQ(fly(
                0.5, [](PoseSample&) {}, RotorState::kOff),
            PoseFault::kNone);
  EXPECT_LT(angle_error(), 0.02);
  EXPECT_GE(estimator_.estimate().resets, 1U);
}

// A shock, as of a fall, leaves a wrong velocity.
TEST_F(EstimatorFaults, RecoversADivergedEstimateWithRotorsOff) {
  fly(3.0);
  imu_error_ = {400.0, -300.0, 200.0};
  fly(
      0.02, [](PoseSample& pose) { pose.tracked = false; }, RotorState::kOff);
  imu_error_.setZero();
  EXPECT_GT(velocity_error(), 8.0);
  EXPECT_EQ(fly(
                0.01,
                [](PoseSample& pose) {
                  pose.q_ned_from_frd = pose.q_ned_from_frd * AngleAxisd(0.3, Vector3d::UnitX());
                },
                RotorState::kOff),
            PoseFault::kOutlier)
      << "the stream is not unbroken";
  EXPECT_EQ(fly(
                1.0, [](PoseSample&) {}, RotorState::kOff),
            PoseFault::kNone);
  EXPECT_LT(velocity_error(), 0.05);
  EXPECT_LT(position_error(), 2e-3);
}

TEST_F(EstimatorFaults, RefusesPosesOfAnotherVehicle) {
  fly(2.0);
  const double start = static_cast<double>(time_ns_) * 1e-9;
  EXPECT_EQ(fly(0.6,
                [&](PoseSample& pose) {
                  const double t = static_cast<double>(pose.stamp_ns) * 1e-9;
                  pose.position_ned = Vector3d(1.5 + (t - start), 0.3, -1.2);
                }),
            PoseFault::kOutlier);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
}

TEST_F(EstimatorFaults, DetectsFrozenMarkersInMotionAtOnce) {
  fly(2.0);
  PoseSample frozen;
  fly(0.01, [&](PoseSample& pose) { frozen = pose; });
  const auto freeze = [&](PoseSample& pose) {
    pose.position_ned = frozen.position_ned;
    pose.q_ned_from_frd = frozen.q_ned_from_frd;
  };
  EXPECT_EQ(fly(0.01, freeze), PoseFault::kFrozen);
  EXPECT_EQ(fly(0.4, freeze), PoseFault::kFrozen);
  EXPECT_LT(position_error(), 0.02);
  EXPECT_EQ(fly(0.05), PoseFault::kNone);
  EXPECT_LT(position_error(), 1e-3);
}

// q and -q are one attitude: motion capture may hand out either, and change at any pose.
class QuaternionSigns : public EstimatorFaults {
 protected:
  static void flip(PoseSample& pose) {
    if (pose.sequence % 2 == 0) pose.q_ned_from_frd.coeffs() *= -1.0;
  }
};

TEST_F(QuaternionSigns, FlippedEachPoseChangeNothing) {
  fly(5.0);
  const Estimate unflipped = estimator_.estimate();
  estimator_ = Estimator(settings_);
  motion_ = NoisyMotion(settings_, 1);
  time_ns_ = 0;
  EXPECT_EQ(fly(5.0, flip), PoseFault::kNone);
  const Estimate& flipped = estimator_.estimate();
  EXPECT_EQ(flipped.poses_refused, 0U);
  EXPECT_LT((flipped.position_ned - unflipped.position_ned).norm(), 1e-12);
  EXPECT_LT((flipped.velocity_ned - unflipped.velocity_ned).norm(), 1e-12);
  EXPECT_LT(flipped.q_ned_from_frd.angularDistance(unflipped.q_ned_from_frd), 1e-7);
  EXPECT_LT((flipped.gyro_bias - unflipped.gyro_bias).norm(), 1e-12);
}

TEST_F(QuaternionSigns, DoNotHideFrozenMarkers) {
  fly(2.0, flip);
  PoseSample frozen;
  fly(0.01, [&](PoseSample& pose) { frozen = pose; });
  const auto freeze = [&](PoseSample& pose) {
    pose.position_ned = frozen.position_ned;
    pose.q_ned_from_frd = frozen.q_ned_from_frd;
    flip(pose);
  };
  EXPECT_EQ(fly(0.01, freeze), PoseFault::kFrozen);
  EXPECT_EQ(fly(0.4, freeze), PoseFault::kFrozen);
  EXPECT_EQ(fly(0.05, flip), PoseFault::kNone);
  EXPECT_LT(position_error(), 1e-3);
}

TEST_F(QuaternionSigns, NeedNoReset) {
  fly(2.0, flip);
  fly(0.2, [](PoseSample& pose) { pose.tracked = false; });
  time_ns_ += 200'000'000;
  EXPECT_EQ(fly(0.5, flip), PoseFault::kNone);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(position_error(), 2e-3);
}

// The reach of a body during IMU silence depends on its maximum speed.
TEST_F(EstimatorFaults, ReachDependsOnTheMaximumSpeed) {
  for (const double max_speed : {4.0, 40.0}) {
    settings_.max_speed = max_speed;
    estimator_ = Estimator(settings_);
    fly(3.0);
    time_ns_ += 250'000'000;
    const PoseFault fault = fly(0.5, [](PoseSample& pose) { pose.position_ned.x() += 3.0; });
    EXPECT_EQ(fault, max_speed > 10.0 ? PoseFault::kNone : PoseFault::kOutlier) << max_speed;
  }
}

// At rest or in hover no motion contradicts a constant pose.
class EstimatorAtRest : public testing::TestWithParam<std::tuple<bool, bool>> {};

TEST_P(EstimatorAtRest, DetectsAFrozenStreamOnlyIfItHadNoise) {
  const bool noisy = std::get<0>(GetParam());
  const bool flips = std::get<1>(GetParam());
  const EstimatorSettings settings;
  Estimator estimator(settings);
  math::RandomStream noise(1, 1);
  std::uint64_t sequence = 0;
  PoseSample last;
  const auto rest = [&](double duration_s, bool frozen, RotorState rotors) {
    const std::int64_t end = estimator.estimate().stamp_ns + static_cast<std::int64_t>(duration_s * 1e9);
    while (estimator.estimate().stamp_ns < end) {
      plant::ImuSample imu;
      imu.stamp_ns = estimator.estimate().stamp_ns + kStep_ns;
      imu.specific_force_frd = Vector3d(0, 0, -plant::kGravity) + 0.05 * noise.normal3();
      imu.body_rates_frd = 3e-3 * noise.normal3();
      estimator.predict(imu);
      if (imu.stamp_ns % kFrame_ns != 0) continue;
      last.stamp_ns = imu.stamp_ns;
      last.sequence = ++sequence;
      last.tracked = true;
      if (noisy && !frozen) last.position_ned = settings.mocap_position_sigma * noise.normal3();
      if (flips && (noisy || !frozen)) last.q_ned_from_frd.coeffs() *= -1.0;
      estimator.correct(last, rotors);
    }
    return estimator.estimate().pose_fault;
  };
  EXPECT_EQ(rest(1.0, false, RotorState::kOff), PoseFault::kNone);
  EXPECT_EQ(rest(1.0, false, RotorState::kRunning), PoseFault::kNone);
  EXPECT_EQ(rest(0.2, true, RotorState::kRunning), noisy ? PoseFault::kFrozen : PoseFault::kNone);
  EXPECT_NEAR(estimator.pose_age_s(), noisy ? 0.16 : 0.0, 0.02);
  EXPECT_EQ(rest(0.1, false, RotorState::kRunning), PoseFault::kNone);
}
INSTANTIATE_TEST_SUITE_P(NoisyFlipping, EstimatorAtRest, testing::Combine(testing::Bool(), testing::Bool()));

TEST_F(EstimatorFaults, ReportsUntimelyUntrackedAndInvalidPoses) {
  fly(1.0);
  const Estimate before = estimator_.estimate();
  PoseSample pose = motion_.pose(time_ns_ - 2 * kFrame_ns);
  EXPECT_FALSE(estimator_.correct(pose));
  EXPECT_EQ(estimator_.estimate().pose_fault, PoseFault::kUntimely);
  EXPECT_FALSE(estimator_.correct(pose));  // the same once more
  EXPECT_EQ(estimator_.estimate().poses_refused, before.poses_refused + 1);
  pose = motion_.pose(time_ns_ + 100'000'000);
  EXPECT_FALSE(estimator_.correct(pose));
  EXPECT_EQ(estimator_.estimate().pose_fault, PoseFault::kUntimely);
  pose = motion_.pose(time_ns_ - 1);
  pose.tracked = false;
  EXPECT_FALSE(estimator_.correct(pose));
  EXPECT_EQ(estimator_.estimate().pose_fault, PoseFault::kUntracked);
  pose = motion_.pose(time_ns_);
  pose.q_ned_from_frd.coeffs() *= 1.02;
  EXPECT_FALSE(estimator_.correct(pose));
  EXPECT_EQ(estimator_.estimate().pose_fault, PoseFault::kInvalid);
  EXPECT_EQ(estimator_.estimate().position_ned, before.position_ned);
  EXPECT_EQ(estimator_.estimate().velocity_ned, before.velocity_ned);
}

// A process that was stopped for 0.2 s at 1 m/s recovers without a reset.
TEST_F(EstimatorFaults, ImuGapGrowsTheCovariance) {
  fly(2.0);
  const double before = estimator_.standard_deviation()[0];
  time_ns_ += 200'000'000;
  estimator_.predict(motion_.imu(time_ns_));
  EXPECT_GT(estimator_.standard_deviation()[0], 100.0 * before);
  EXPECT_EQ(fly(0.3), PoseFault::kNone);
  EXPECT_EQ(estimator_.estimate().resets, 0U);
  EXPECT_LT(position_error(), 2e-3);
}

}  // namespace swiftlet::control::estimator_faults_test

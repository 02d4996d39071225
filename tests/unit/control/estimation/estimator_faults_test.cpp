// Faulty poses: which are refused, with which fault, and when the estimate is reset.
#include "tests/unit/control/estimation/estimator_faults.hpp"

#include <cmath>
#include <cstdint>
#include <tuple>

#include <gtest/gtest.h>

namespace swiftlet::control::estimator_faults_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::PoseSample;
using plant::RotorState;

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

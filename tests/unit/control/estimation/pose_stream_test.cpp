#include "swiftlet/control/estimation/pose_stream.hpp"

#include <cstdint>

#include <gtest/gtest.h>

namespace swiftlet::control::pose_stream_test {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using plant::PoseSample;
using plant::RotorState;

constexpr std::int64_t kFrame_ns = 10'000'000;

PoseSample pose(int frame, const Vector3d& position_ned, const Quaterniond& q = Quaterniond::Identity()) {
  PoseSample sample;
  sample.stamp_ns = (1 + frame) * kFrame_ns;
  sample.tracked = true;
  sample.position_ned = position_ned;
  sample.q_ned_from_frd = q;
  return sample;
}

// Noise in steps of a tenth of a millimetre.
Vector3d noisy(int frame) { return {1e-4 * ((frame * 7919) % 13 - 6), 0.0, -1.0}; }

class StuckPose : public testing::Test {
 protected:
  void see(const Vector3d& position_ned, RotorState rotors, const Quaterniond& q = Quaterniond::Identity()) {
    detector_.update(pose(frame_++, position_ned, q), rotors);
  }
  void stand_in_noise() {
    for (int i = 0; i < 40; ++i) see(noisy(i), RotorState::kOff);
  }
  StuckPoseDetector detector_;
  int frame_ = 0;
};

TEST_F(StuckPose, IsFrozenFiveRepetitionsAfterNoiseStops) {
  stand_in_noise();
  see({0.0, 0.0, -1.0}, RotorState::kRunning);
  EXPECT_FALSE(detector_.repeats());
  for (int i = 1; i <= 8; ++i) {
    see({0.0, 0.0, -1.0}, RotorState::kRunning);
    EXPECT_TRUE(detector_.repeats());
    EXPECT_EQ(detector_.frozen(), i >= StuckPoseSettings{}.repetitions) << i;
  }
  see({0.001, 0.0, -1.0}, RotorState::kRunning);
  EXPECT_FALSE(detector_.repeats());
  EXPECT_FALSE(detector_.frozen()) << "the poses change again";
}

TEST_F(StuckPose, NoiselessStreamRepeatsButIsNotFrozen) {
  for (int i = 0; i < 100; ++i) see({0.0, 0.0, -1.0}, RotorState::kOff);
  for (int i = 0; i < 100; ++i) see({0.0, 0.0, -1.0}, RotorState::kRunning);
  EXPECT_TRUE(detector_.repeats());
  EXPECT_FALSE(detector_.frozen());
}

// Motion in flight is no evidence of noise.
TEST_F(StuckPose, LearnsNoiseOnlyWithRotorsOff) {
  for (int i = 0; i < 100; ++i) see({0.01 * i, 0.0, -1.0}, RotorState::kRunning);
  for (int i = 0; i < 100; ++i) see({1.0, 0.0, -1.0}, RotorState::kRunning);
  EXPECT_FALSE(detector_.frozen());
}

TEST_F(StuckPose, DoesNotLearnNoiseFromTwentyPoses) {
  for (int i = 0; i < 20; ++i) see(noisy(i), RotorState::kOff);  // 19 that differ from the one before
  for (int i = 0; i < 10; ++i) see({1.0, 0.0, -1.0}, RotorState::kRunning);
  EXPECT_FALSE(detector_.frozen());
}

TEST_F(StuckPose, RotationIsNoRepetition) {
  stand_in_noise();
  for (int i = 0; i < 20; ++i)
    see({0.0, 0.0, -1.0}, RotorState::kRunning, Quaterniond(AngleAxisd(0.001 * i, Vector3d::UnitZ())));
  EXPECT_FALSE(detector_.repeats());
}

// q and -q are one attitude: a change of the sign is neither a motion nor noise.
TEST_F(StuckPose, IgnoresTheSignOfTheQuaternion) {
  const Quaterniond q(AngleAxisd(0.3, Vector3d(0.6, 0.0, 0.8)));
  const Quaterniond minus_q(Quaterniond(-q.coeffs()));
  for (int i = 0; i < 60; ++i) see({0.0, 0.0, -1.0}, RotorState::kOff, i % 2 == 0 ? q : minus_q);
  EXPECT_TRUE(detector_.repeats());
  for (int i = 0; i < 10; ++i) see({0.0, 0.0, -1.0}, RotorState::kRunning, q);
  EXPECT_FALSE(detector_.frozen()) << "there was no noise";
}

class PoseTrack : public testing::Test {
 protected:
  PoseTrack() {
    for (int i = 0; i < 30; ++i) see(i);
    continuity_.begin();
  }
  // The vehicle flies north at 1 m/s and turns right at 1 rad/s; the pose has an offset from that.
  void see(int frame, const Vector3d& off_ned = Vector3d::Zero(), double off_yaw = 0.0) {
    const double t = 0.01 * frame;
    continuity_.update(pose(frame, Vector3d(t, 0.0, -1.0) + off_ned,
                            Quaterniond(AngleAxisd(t + off_yaw, Vector3d::UnitZ()))));
    frame_ = frame + 1;
  }
  void see_many(int count, const Vector3d& off_ned = Vector3d::Zero(), double off_yaw = 0.0) {
    for (int i = 0; i < count; ++i) see(frame_, off_ned, off_yaw);
  }
  PoseContinuity continuity_;
  int frame_ = 0;
};

TEST_F(PoseTrack, IsUnbrokenForAMovingBody) {
  see_many(50);
  EXPECT_TRUE(continuity_.unbroken());
  EXPECT_TRUE(continuity_.in_reach());
  EXPECT_EQ(continuity_.poses(), 80);
  EXPECT_DOUBLE_EQ(continuity_.interval_s(), 0.01);
  EXPECT_LT((continuity_.velocity_ned() - Vector3d(1.0, 0.0, 0.0)).norm(), 1e-9);
}

TEST_F(PoseTrack, IsOutOfReachAfterAStepUntilItStepsBack) {
  const Vector3d steps[] = {{0.3, 0.0, 0.0}, {0.0, -0.3, 0.0}, {0.0, 0.0, 0.3}};
  for (const Vector3d& step : steps) {
    see_many(10, step);
    EXPECT_FALSE(continuity_.unbroken());
    EXPECT_FALSE(continuity_.in_reach());
    EXPECT_EQ(continuity_.poses(), 10) << "since the step";
    see_many(10);
    EXPECT_TRUE(continuity_.unbroken());
    EXPECT_TRUE(continuity_.in_reach());
  }
}

TEST_F(PoseTrack, IsOutOfReachAfterAYawJumpUntilItTurnsBack) {
  see_many(10, Vector3d::Zero(), 0.4);
  EXPECT_FALSE(continuity_.in_reach());
  see_many(10, Vector3d::Zero(), 0.8);
  EXPECT_FALSE(continuity_.in_reach()) << "a further turn does not lead back";
  see_many(10);
  EXPECT_TRUE(continuity_.in_reach());
}

// Rotations about different axes do not commute: steps are undone in reverse order only.
TEST_F(PoseTrack, UndoesRotationsInReverseOrderOnly) {
  PoseContinuity still;
  const Quaterniond a(AngleAxisd(1.2, Vector3d::UnitX()));
  const Quaterniond b(AngleAxisd(1.2, Vector3d::UnitZ()));
  const Quaterniond attitudes[] = {Quaterniond::Identity(), a, a * b, a * b * a.conjugate(),
                                   a * b * a.conjugate() * b.conjugate()};
  int frame = 0;
  for (const Quaterniond& q : attitudes) {
    still.update(pose(frame, Vector3d::Zero(), q));
    if (frame++ == 0) still.begin();
  }
  EXPECT_FALSE(still.in_reach()) << "the commutator of the rotations is left";
  still.update(pose(frame, Vector3d::Zero()));
  EXPECT_TRUE(still.in_reach());
}

TEST_F(PoseTrack, IsBrokenByALongGap) {
  see(frame_ + 8);
  EXPECT_TRUE(continuity_.unbroken()) << "90 ms";
  see(frame_ + 10);
  EXPECT_FALSE(continuity_.unbroken()) << "110 ms";
  EXPECT_TRUE(continuity_.in_reach());
  see_many(100);
  EXPECT_FALSE(continuity_.unbroken()) << "until the estimate agrees";
  continuity_.begin();
  EXPECT_TRUE(continuity_.unbroken());
}

TEST_F(PoseTrack, ReachGrowsWithTheInterval) {
  see(frame_, {0.12, 0.0, 0.0});
  EXPECT_FALSE(continuity_.in_reach()) << "13 cm in 10 ms";
  see(frame_);
  ASSERT_TRUE(continuity_.in_reach());
  see(frame_ + 4, {0.12, 0.0, 0.0});
  EXPECT_TRUE(continuity_.in_reach()) << "17 cm in 50 ms";
}

TEST_F(PoseTrack, ReturnsIntoReachWithAStepAfterRejection) {
  continuity_.reject_track();
  EXPECT_FALSE(continuity_.unbroken());
  see_many(10);
  EXPECT_FALSE(continuity_.unbroken());
  see_many(5, {0.5, 0.0, 0.0});
  EXPECT_TRUE(continuity_.in_reach()) << "a step may return to the body";
  see_many(5);
  EXPECT_FALSE(continuity_.in_reach()) << "the next step leaves it again";
}

TEST_F(PoseTrack, LastsAfterEightPosesAndAFifthOfASecond) {
  EXPECT_TRUE(continuity_.lasting());
  see(frame_, {0.5, 0.0, 0.0});
  for (int i = 1; i <= 30; ++i) {
    see(frame_, {0.5, 0.0, 0.0});
    EXPECT_EQ(continuity_.lasting(), i >= 20) << i;
  }
  PoseContinuity slow;  // 20 Hz
  for (int i = 0; i < 10; ++i) {
    slow.update(pose(5 * i, {0.0, 0.0, -1.0}));
    EXPECT_EQ(slow.lasting(), i >= 7) << i;
  }
}

TEST_F(PoseTrack, IgnoresTheSignOfTheQuaternion) {
  for (int i = 0; i < 40; ++i) {
    const double t = 0.01 * frame_;
    Quaterniond q(AngleAxisd(t, Vector3d::UnitZ()));
    if (i % 2 == 0) q.coeffs() *= -1.0;
    continuity_.update(pose(frame_++, {t, 0.0, -1.0}, q));
  }
  EXPECT_TRUE(continuity_.unbroken());
  EXPECT_EQ(continuity_.poses(), 70);
}

TEST(PoseContinuity, HasNoVelocityBeforeFivePoses) {
  PoseContinuity continuity;
  for (int i = 0; i < 4; ++i) continuity.update(pose(i, {0.01 * i, 0.0, 0.0}));
  EXPECT_EQ(continuity.velocity_ned(), Vector3d::Zero());
  continuity.update(pose(4, {0.04, 0.0, 0.0}));
  EXPECT_LT((continuity.velocity_ned() - Vector3d(1.0, 0.0, 0.0)).norm(), 1e-9);
}

}  // namespace swiftlet::control::pose_stream_test

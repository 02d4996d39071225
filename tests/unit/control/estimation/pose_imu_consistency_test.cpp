// Poses against the path of the IMU: which of their differences the test rejects.
#include "swiftlet/control/estimation/pose_imu_consistency.hpp"

#include <cstdint>

#include <gtest/gtest.h>

#include "tests/unit/control/estimation/estimator_motion.hpp"

namespace swiftlet::control::pose_imu_consistency_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using Result = PoseImuConsistencyTest::Result;

// The IMU's path starts at any position, speed and attitude: none of these contradicts the poses.
struct Path {
  Vector3d offset_ned;   // m
  Vector3d speed_ned;    // m/s
  Quaterniond turn_ned;  // of the poses against it

  // The specific force turns with the attitude, gravity does not.
  Vector3d position(double t) const {
    const Vector3d start = Motion::position(0.0) + t * Motion::velocity(0.0);
    const Vector3d fall(0.0, 0.0, 0.5 * plant::kGravity * t * t);
    return offset_ned + t * speed_ned + fall + turn_ned.conjugate() * (Motion::position(t) - start - fall);
  }
  Quaterniond attitude(double t) const { return turn_ned.conjugate() * Motion::attitude(t); }
};

class PoseImuConsistency : public testing::TestWithParam<std::uint64_t> {
 protected:
  // Counts the verdicts over a second of poses at 100 Hz that are rotated in body axes.
  void run(const Vector3d& turned_frd) {
    for (int frame = 0; frame < 100; ++frame) {
      take_pose(frame, turned_frd);
      PoseInnovation innovation;
      const double t = static_cast<double>(pose_.stamp_ns) * 1e-9;
      innovation.position = pose_.position_ned - path_.position(t);
      innovation.rotation = rotation_vector(pose_.q_ned_from_frd * path_.attitude(t).conjugate());
      const Result result = test_.update(pose_, innovation, settings_);
      agree_ += result == Result::kAgree ? 1 : 0;
      disagree_ += result == Result::kDisagree ? 1 : 0;
    }
  }
  void take_pose(int frame, const Vector3d& turned_frd) {
    const std::int64_t stamp_ns = frame * kFrame_ns;
    pose_ = Motion::pose(stamp_ns, 1);
    pose_.position_ned += settings_.mocap_position_sigma * random_.normal3();
    pose_.q_ned_from_frd = rotation(settings_.mocap_orientation_sigma * random_.normal3()) *
                           pose_.q_ned_from_frd * rotation(turned_frd);
  }

  const EstimatorSettings settings_{};
  math::RandomStream random_{GetParam(), 1};
  const Path path_{random_.normal3(), random_.normal3(), rotation(0.3 * random_.normal3())};
  plant::PoseSample pose_;
  PoseImuConsistencyTest test_;
  int agree_ = 0;
  int disagree_ = 0;
};

TEST_P(PoseImuConsistency, AgreesForAnyStartOfThePath) {
  run(Vector3d::Zero());
  EXPECT_EQ(disagree_, 0);
  EXPECT_EQ(agree_, 15) << "one for each interval but the first";
}

TEST_P(PoseImuConsistency, DisagreesWithATilt) {
  Vector3d turned_frd = random_.normal3();
  turned_frd.z() = 0.0;
  run(0.07 * turned_frd.normalized());
  EXPECT_EQ(agree_, 0);
}

INSTANTIATE_TEST_SUITE_P(Seed, PoseImuConsistency, testing::Range<std::uint64_t>(1, 21));

TEST(PoseImuConsistencyTest, RestartsAfterBegin) {
  PoseImuConsistencyTest test;
  const EstimatorSettings settings;
  plant::PoseSample pose;
  const auto update = [&](double z_ned) {
    pose.stamp_ns += static_cast<std::int64_t>(1e9 * settings.detectors.pose_imu_consistency.interval_s);
    pose.position_ned.z() = z_ned;
    return test.update(pose, {{0.0, 0.0, z_ned}, Vector3d::Zero()}, settings);
  };
  EXPECT_EQ(update(0.0), Result::kNone);
  EXPECT_EQ(update(0.0), Result::kNone);
  EXPECT_EQ(update(0.0), Result::kAgree);
  EXPECT_EQ(update(0.5), Result::kDisagree);
  test.begin();
  EXPECT_EQ(update(0.5), Result::kNone);
  EXPECT_EQ(update(0.5), Result::kNone);
  EXPECT_EQ(update(0.5), Result::kAgree);
}

}  // namespace swiftlet::control::pose_imu_consistency_test

// Poses of a vehicle at rest from a recorded OptiTrack session (tests/data/README.md), with a simulated IMU
// that measures gravity only.
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::estimator_replay_test {

constexpr std::size_t kAtRest = 200;  // rows

std::vector<plant::PoseSample> session() {
  std::ifstream file(tests::in_source("tests/data/optitrack_poses.csv"));
  std::string names;
  std::getline(file, names);
  std::vector<plant::PoseSample> poses;
  double start_s = 0.0;
  for (double t = 0.0; poses.size() < kAtRest && file >> t;) {
    double values[7];
    for (double& value : values) file.ignore(1, ',') >> value;
    if (poses.empty()) start_s = t - 0.1;
    plant::PoseSample pose;
    pose.stamp_ns = std::llround((t - start_s) * 1e9);
    pose.sequence = poses.size() + 1;
    pose.tracked = true;
    pose.position_ned = {values[0], -values[1], -values[2]};  // its z points up
    pose.q_ned_from_frd = Eigen::Quaterniond(values[6], values[3], -values[4], -values[5]);
    poses.push_back(pose);
  }
  return poses;
}

TEST(EstimatorReplay, AcceptsARecordedSessionAtRest) {
  const std::vector<plant::PoseSample> poses = session();
  ASSERT_EQ(poses.size(), kAtRest);
  const Eigen::Vector3d weight =
      poses[0].q_ned_from_frd.conjugate() * Eigen::Vector3d(0.0, 0.0, -plant::kGravity);
  Estimator estimator{EstimatorSettings{}};
  plant::ImuSample imu;
  double innovations = 0.0;
  for (const plant::PoseSample& pose : poses) {
    while (imu.stamp_ns < pose.stamp_ns) {
      imu.stamp_ns += 2'000'000;
      imu.specific_force_frd = weight;
      ASSERT_TRUE(estimator.predict(imu));
    }
    estimator.correct(pose, plant::RotorState::kOff);
    innovations += estimator.normalised_innovation() / kAtRest;
  }
  EXPECT_EQ(estimator.estimate().poses_refused, 0U) << to_string(estimator.estimate().pose_fault);
  EXPECT_LT((estimator.estimate().position_ned - poses[0].position_ned).norm(), 2e-4);
  EXPECT_LT(estimator.estimate().velocity_ned.norm(), 5e-3);
  EXPECT_LT(estimator.estimate().gyro_bias.norm(), 2e-3);
  EXPECT_LT(innovations, 10.0);  // 6 with the noise that the filter assumes
}

}  // namespace swiftlet::control::estimator_replay_test

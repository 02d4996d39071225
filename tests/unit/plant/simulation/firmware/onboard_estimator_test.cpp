#include "swiftlet/plant/simulation/firmware/onboard_estimator.hpp"

#include <cmath>
#include <deque>

#include <gtest/gtest.h>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::tests::onboard_estimator_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kStep_s = 0.002;
constexpr std::int64_t kStepNs = 2'000'000;

// A vehicle that flies a circle while its yaw turns with it, measured by an IMU with biases, and by motion capture at
// 100 Hz whose poses arrive 10 ms late.
class Circle : public testing::Test {
 protected:
  static constexpr double kRadius_m = 0.5, kRate = 1.0;

  static Vector3d position(double t) {
    return {kRadius_m * std::cos(kRate * t), kRadius_m * std::sin(kRate * t), -1.0};
  }
  static Vector3d velocity(double t) {
    return {-kRadius_m * kRate * std::sin(kRate * t), kRadius_m * kRate * std::cos(kRate * t), 0.0};
  }
  static Quaterniond attitude(double t) { return math::rotation(Vector3d(0.0, 0.0, kRate * t)); }

  void step() {
    ++steps_;
    const double t = kStep_s * steps_;
    const Vector3d acceleration(-kRadius_m * kRate * kRate * std::cos(kRate * t),
                                -kRadius_m * kRate * kRate * std::sin(kRate * t), 0.0);
    plant::ImuSample imu;
    imu.stamp_ns = kStepNs * steps_;
    imu.specific_force_frd =
        attitude(t).conjugate() * (acceleration - plant::kGravity * Vector3d::UnitZ()) + force_bias_;
    imu.body_rates_frd = Vector3d(0.0, 0.0, kRate) + gyro_bias_;
    estimator_.predict(imu, kStep_s);
    if (steps_ % 5 != 0) return;
    plant::PoseSample pose;
    pose.stamp_ns = imu.stamp_ns;
    pose.tracked = true;
    pose.position_ned = position(t) + jump_;
    pose.q_ned_from_frd = attitude(t);
    under_way_.push_back(pose);
    if (under_way_.size() < 2) return;
    estimator_.correct(under_way_.front());
    under_way_.pop_front();
  }
  void run(double duration_s) {
    for (double t = 0.0; t < duration_s; t += kStep_s) step();
  }
  double position_error_m() const { return (estimator_.position_ned() - position(kStep_s * steps_)).norm(); }

  plant::OnboardEstimator estimator_;
  std::deque<plant::PoseSample> under_way_;
  Vector3d force_bias_{0.1, -0.1, 0.1};
  Vector3d gyro_bias_{0.01, -0.01, 0.01};
  Vector3d jump_ = Vector3d::Zero();
  int steps_ = 0;
};

TEST_F(Circle, IsFollowedInSpiteOfBiasesAndLatency) {
  run(10.0);
  const double t = kStep_s * steps_;
  EXPECT_LT(position_error_m(), 5e-3);
  EXPECT_LT((estimator_.velocity_ned() - velocity(t)).norm(), 0.03);
  EXPECT_LT(estimator_.q_ned_from_frd().angularDistance(attitude(t)), 0.01);
  EXPECT_LT((estimator_.body_rates_frd() - Vector3d(0.0, 0.0, kRate)).norm(), 3e-3);
}

TEST_F(Circle, ASinglePoseThatIsFarOffIsSkipped) {
  run(5.0);
  jump_.x() = 2.0;
  run(0.02);
  jump_.setZero();
  run(0.05);
  EXPECT_LT(position_error_m(), 5e-3);
}

TEST_F(Circle, PosesThatStayFarOffAreFollowedInTheEnd) {
  run(5.0);
  jump_.x() = 2.0;
  run(3.0);
  EXPECT_LT((estimator_.position_ned() - position(kStep_s * steps_) - jump_).norm(), 0.02);
}

TEST(OnboardEstimator, StandsStillBeforeTheFirstPose) {
  plant::OnboardEstimator estimator;
  plant::ImuSample imu;
  imu.specific_force_frd = {1.0, 1.0, 1.0};
  for (int i = 1; i < 100; ++i) {
    imu.stamp_ns = kStepNs * i;
    estimator.predict(imu, kStep_s);
  }
  EXPECT_FALSE(estimator.initialised());
  EXPECT_EQ(estimator.position_ned(), Vector3d::Zero());
  plant::PoseSample untracked;
  untracked.stamp_ns = kStepNs * 99;
  estimator.correct(untracked);
  EXPECT_FALSE(estimator.initialised());
}

}  // namespace swiftlet::tests::onboard_estimator_test

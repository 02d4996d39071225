// A vehicle in motion whose poses, or IMU, can be faulty.
#pragma once

#include <cstdint>
#include <functional>

#include <gtest/gtest.h>

#include "swiftlet/control/estimation/estimator.hpp"
#include "tests/unit/control/estimation/estimator_motion.hpp"

namespace swiftlet::control {

// Poses at 100 Hz, 10 ms late, from a moving vehicle.
class EstimatorFaults : public testing::Test {
 protected:
  using Change = std::function<void(plant::PoseSample&)>;

  // Returns the fault of the last pose.
  PoseFault fly(
      double duration_s, const Change& change = [](plant::PoseSample&) {},
      plant::RotorState rotors = plant::RotorState::kRunning) {
    const std::int64_t end = time_ns_ + static_cast<std::int64_t>(duration_s * 1e9);
    while (time_ns_ < end) {
      time_ns_ += kStep_ns;
      plant::ImuSample imu = motion_.imu(time_ns_);
      imu.specific_force_frd = hidden_turn_.conjugate() * imu.specific_force_frd + imu_error_;
      imu.body_rates_frd = hidden_turn_.conjugate() * imu.body_rates_frd;
      EXPECT_TRUE(estimator_.predict(imu));
      if (time_ns_ % kFrame_ns != 0 || time_ns_ < 2 * kFrame_ns) continue;
      plant::PoseSample pose = pose_now();
      change(pose);
      estimator_.correct(pose, rotors);
    }
    return estimator_.estimate().pose_fault;
  }
  plant::PoseSample pose_now() {
    plant::PoseSample pose = motion_.pose(time_ns_ - kFrame_ns);
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
  Eigen::Vector3d imu_error_ = Eigen::Vector3d::Zero();              // m/s^2
  Eigen::Quaterniond hidden_turn_ = Eigen::Quaterniond::Identity();  // of the body, in no IMU sample
  std::int64_t time_ns_ = 0;
};

}  // namespace swiftlet::control

// State estimate: the IMU propagates, mocap corrects. Position, velocity, attitude, gyro and accelerometer
// bias.
//
// Two fixed-gain observers with critically damped poles (fading-memory filters, Morrison 1969): position,
// velocity and accelerometer bias in one, attitude and gyro bias in the other. A pose is compared with the
// estimate at the pose's own stamp, and the correction is brought forward to now, so that latency costs no
// stability.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "control/settings.hpp"
#include "plant/model/samples.hpp"

namespace swiftlet::control {

struct Estimate {
  std::int64_t stamp_ns = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s, bias removed
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();           // rad/s
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();  // m/s^2, in FRD
};

class Estimator {
 public:
  explicit Estimator(const EstimatorSettings& settings);

  // Brings the estimate forward to the sample. Returns false, and changes nothing, for a sample that is not
  // finite or not newer than the last. A gap in the samples is bridged with the last rates and specific
  // force.
  bool predict(const plant::ImuSample& sample);

  // Takes a pose in. Returns false, and changes nothing, for one that is untracked, not finite, not newer
  // than the last, older than the kept history, or too far from the estimate; kRejectionsToReset of the last
  // kind in a row start the estimate anew.
  bool correct(const plant::PoseSample& pose);

  // A pose has been taken in, so the estimate has a meaning.
  bool initialised() const { return initialised_; }
  const Estimate& estimate() const { return now_; }
  // From the exposure of the last pose taken in to the estimate's stamp; infinite before the first.
  double pose_age_s() const;
  std::uint64_t pose_sequence() const { return pose_sequence_; }

  static constexpr int kHistory = 256;  // IMU samples: 0.5 s at 500 Hz
  static constexpr int kRejectionsToReset = 20;

 private:
  struct Past {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
    Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  };

  Past& past(int steps_back) {
    return history_[static_cast<std::size_t>((head_ - steps_back + kHistory) % kHistory)];
  }
  void start_at(const plant::PoseSample& pose);
  void remember();

  EstimatorSettings settings_;
  Estimate now_;
  plant::ImuSample last_imu_;
  bool initialised_ = false;
  std::int64_t pose_stamp_ns_ = 0;
  std::uint64_t pose_sequence_ = 0;
  int rejections_ = 0;
  std::array<Past, kHistory> history_;
  int head_ = 0;
  int filled_ = 0;
};

}  // namespace swiftlet::control

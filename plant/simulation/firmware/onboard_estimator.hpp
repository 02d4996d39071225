// Estimator on board of the simulated vehicle, for the loops that need attitude or position: IMU integration with
// fixed-gain correction by poses of motion capture, as small autopilots have it (Luenberger observer). It knows nothing
// of the ground truth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::plant {

class OnboardEstimator {
 public:
  // dt_s > 0: since the last sample.
  void predict(const ImuSample& sample, double dt_s);
  // A tracked pose, compared with the own pose at its stamp. The first one sets the state. One that is too far off to
  // be true is skipped; many of those in a row set the state anew.
  void correct(const PoseSample& pose);

  bool initialised() const { return pose_stamp_ns_ >= 0; }
  const Eigen::Vector3d& position_ned() const { return now_.position_ned; }
  const Eigen::Vector3d& velocity_ned() const { return velocity_ned_; }
  const Eigen::Quaterniond& q_ned_from_frd() const { return now_.q_ned_from_frd; }
  Eigen::Vector3d body_rates_frd() const { return gyro_ - gyro_bias_; }

 private:
  struct Pose {
    std::int64_t stamp_ns = -1;
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();
    Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  };
  const Pose& past(std::int64_t stamp_ns) const;
  void set(const PoseSample& pose);

  Pose now_;
  Eigen::Vector3d velocity_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d force_bias_frd_ = Eigen::Vector3d::Zero();  // of the accelerometer, m/s^2
  std::array<Pose, 128> history_{};                           // at the stamps of the last samples
  std::size_t newest_ = 0;
  std::int64_t pose_stamp_ns_ = -1;
  int skipped_ = 0;  // poses in a row
};

}  // namespace swiftlet::plant

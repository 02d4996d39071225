// Tests whether poses and IMU show one motion. After an IMU silence the estimated attitude is too uncertain
// to judge a pose. But poses with a wrong attitude contradict the IMU by themselves: rotated by their
// attitude, the specific force is not the acceleration with which they move.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/error_covariance.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/samples.hpp"

namespace swiftlet::control {

class PoseImuConsistencyTest {
 public:
  enum class Result : std::uint8_t { kNone, kAgree, kDisagree };

  // Adds a pose and its innovation from the path that the IMU alone has propagated since begin(). Returns a
  // result over the last two intervals whenever an interval ends. Uses the pose noise and
  // detectors.pose_imu_consistency of the settings.
  Result update(const plant::PoseSample& pose, const PoseInnovation& innovation,
                const EstimatorSettings& settings);
  void begin() { count_ = 0; }

 private:
  struct Point {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();        // of the pose
    Eigen::Vector3d path_ned = Eigen::Vector3d::Zero();            // of the IMU-propagated path
    Eigen::Quaterniond turn_ned = Eigen::Quaterniond::Identity();  // rotation from the path to the pose
  };
  bool agree(const EstimatorSettings& settings) const;

  std::array<Point, 3> points_;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::control

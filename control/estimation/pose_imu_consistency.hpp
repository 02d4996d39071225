// Whether poses and the IMU tell of one motion. After a silence of the IMU the estimate does not know the
// attitude well enough to judge a pose by it; but poses that are turned wrong contradict the IMU by
// themselves: under their attitude, the specific force is not the acceleration with which they move.
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
  enum class Verdict : std::uint8_t { kNone, kAgree, kDisagree };

  // The next pose, and what it differs by from the path that the IMU alone has drawn since the trial began: a
  // verdict over the last two intervals, each time that one is over. Of the settings, the noise of the poses and
  // detectors.pose_imu_consistency count.
  Verdict look_at(const plant::PoseSample& pose, const PoseInnovation& innovation,
                  const EstimatorSettings& settings);
  void begin() { count_ = 0; }

 private:
  struct Point {
    std::int64_t stamp_ns = 0;
    Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();        // of the pose
    Eigen::Vector3d path_ned = Eigen::Vector3d::Zero();            // of the IMU's path
    Eigen::Quaterniond turn_ned = Eigen::Quaterniond::Identity();  // of the pose against the path
  };
  bool agree(const EstimatorSettings& settings) const;

  std::array<Point, 3> points_;
  std::size_t count_ = 0;
};

}  // namespace swiftlet::control

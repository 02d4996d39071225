#include "swiftlet/control/estimation/pose_imu_consistency.hpp"

#include <cmath>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
PoseImuConsistencyTest::Result PoseImuConsistencyTest::update(const plant::PoseSample& pose,
                                                              const PoseInnovation& innovation,
                                                              const EstimatorSettings& settings) {
  if (count_ > 0 && math::seconds(pose.stamp_ns - points_[count_ - 1].stamp_ns) <
                        settings.detectors.pose_imu_consistency.interval_s)
    return Result::kNone;
  points_[count_++] = {pose.stamp_ns, pose.position_ned, pose.position_ned - innovation.position,
                       math::rotation(innovation.rotation)};
  if (count_ < points_.size()) return Result::kNone;
  const Result result = agree(settings) ? Result::kAgree : Result::kDisagree;
  points_[0] = points_[1];
  points_[1] = points_[2];
  --count_;
  return result;
}

// The IMU's path is p + t v + t^2/2 g + S, S being the double integral of the specific force. The poses
// follow the same with turn * S, from another p and with another v. So the poses without g and turn * S must
// move along a straight line at constant velocity.
bool PoseImuConsistencyTest::agree(const EstimatorSettings& settings) const {
  const PoseImuConsistencySettings& limits = settings.detectors.pose_imu_consistency;
  const Eigen::Quaterniond& turn = points_[1].turn_ned;
  const double turn_limit =
      limits.turn_rad + limits.sigmas * std::sqrt(2.0) * settings.mocap_orientation_sigma;
  for (const Point& point : points_) {
    if (math::rotation_vector(point.turn_ned * turn.conjugate()).norm() > turn_limit) return false;
  }
  const auto residual = [&](const Point& point) -> Eigen::Vector3d {
    const double t = math::seconds(point.stamp_ns - points_[0].stamp_ns);
    const Eigen::Vector3d fall(0.0, 0.0, 0.5 * plant::kGravity * t * t);
    return (point.position_ned - fall) - turn * (point.path_ned - fall);
  };
  const double t1 = math::seconds(points_[1].stamp_ns - points_[0].stamp_ns);
  const double t2 = math::seconds(points_[2].stamp_ns - points_[1].stamp_ns);
  const Eigen::Vector3d start = residual(points_[0]);
  const Eigen::Vector3d middle = residual(points_[1]);
  const Eigen::Vector3d end = residual(points_[2]);
  const Eigen::Vector3d acceleration = 2.0 * ((end - middle) / t2 - (middle - start) / t1) / (t1 + t2);
  const double noise = limits.sigmas * std::sqrt(6.0) * settings.mocap_position_sigma / (t1 * t2);
  return acceleration.norm() < limits.acceleration + noise;
}

}  // namespace swiftlet::control

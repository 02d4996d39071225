#include "swiftlet/plant/simulation/firmware/onboard_estimator.hpp"

#include <algorithm>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {
namespace {

constexpr double kPositionPole = 6.0;        // rad/s, triple, of position, velocity and accelerometer bias
constexpr double kAttitudePole = 4.0;        // rad/s, double, of attitude and gyro bias
constexpr double kLongestInterval_s = 0.05;  // between two poses: longer gaps correct no faster
constexpr double kLargestStep_m = 0.25;
constexpr double kLargestTurn_rad = 0.5;
constexpr int kSkippedUntilReset = 25;

}  // namespace

void OnboardEstimator::predict(const ImuSample& sample, double dt_s) {
  gyro_ = sample.body_rates_frd;
  now_.stamp_ns = sample.stamp_ns;
  if (!initialised()) return;
  now_.q_ned_from_frd = math::renormalised(now_.q_ned_from_frd * math::rotation(body_rates_frd() * dt_s));
  const Eigen::Vector3d acceleration_ned =
      now_.q_ned_from_frd * (sample.specific_force_frd - force_bias_frd_) +
      kGravity * Eigen::Vector3d::UnitZ();
  now_.position_ned += dt_s * (velocity_ned_ + 0.5 * dt_s * acceleration_ned);
  velocity_ned_ += dt_s * acceleration_ned;
  newest_ = (newest_ + 1) % history_.size();
  history_[newest_] = now_;
}

// The newest pose that is not later than the stamp, or the oldest there is.
const OnboardEstimator::Pose& OnboardEstimator::past(std::int64_t stamp_ns) const {
  std::size_t found = newest_;
  for (std::size_t back = 0; back < history_.size(); ++back) {
    const std::size_t i = (newest_ + history_.size() - back) % history_.size();
    if (history_[i].stamp_ns < 0) break;
    found = i;
    if (history_[i].stamp_ns <= stamp_ns) break;
  }
  return history_[found];
}

void OnboardEstimator::set(const PoseSample& pose) {
  now_.position_ned = pose.position_ned;
  now_.q_ned_from_frd = pose.q_ned_from_frd;
  velocity_ned_.setZero();
  for (Pose& entry : history_) entry.stamp_ns = -1;
  history_[newest_] = now_;
  pose_stamp_ns_ = pose.stamp_ns;
  skipped_ = 0;
}

void OnboardEstimator::correct(const PoseSample& pose) {
  if (!pose.tracked || pose.stamp_ns <= pose_stamp_ns_) return;
  if (!initialised()) return set(pose);
  const Pose& then = past(pose.stamp_ns);
  const Eigen::Vector3d step_ned = pose.position_ned - then.position_ned;
  const Eigen::Vector3d turn_frd =
      math::rotation_vector(then.q_ned_from_frd.conjugate() * pose.q_ned_from_frd);
  if (step_ned.norm() > kLargestStep_m || turn_frd.norm() > kLargestTurn_rad) {
    if (++skipped_ >= kSkippedUntilReset) set(pose);
    return;
  }
  skipped_ = 0;
  const double dt_s =
      std::min(1e-9 * static_cast<double>(pose.stamp_ns - pose_stamp_ns_), kLongestInterval_s);
  pose_stamp_ns_ = pose.stamp_ns;
  const Eigen::Vector3d correction_ned = kPositionPole * dt_s * step_ned;
  now_.position_ned += 3.0 * correction_ned;
  velocity_ned_ += 3.0 * kPositionPole * correction_ned;
  force_bias_frd_ -= kPositionPole * kPositionPole * (now_.q_ned_from_frd.conjugate() * correction_ned);
  now_.q_ned_from_frd =
      math::renormalised(now_.q_ned_from_frd * math::rotation(2.0 * kAttitudePole * dt_s * turn_frd));
  gyro_bias_ -= kAttitudePole * kAttitudePole * dt_s * turn_frd;
  history_[newest_] = now_;
}

}  // namespace swiftlet::plant

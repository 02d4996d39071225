#include "swiftlet/control/estimation/pose_stream.hpp"

#include <algorithm>

#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::control {
namespace {

// True if no component differs by `distance` or more: m of position, or quaternion. q and -q are one
// attitude.
bool closer(const plant::PoseSample& a, const plant::PoseSample& b, double distance) {
  const Eigen::Vector4d q_a = a.q_ned_from_frd.coeffs();
  const Eigen::Vector4d q_b = b.q_ned_from_frd.coeffs();
  return (a.position_ned - b.position_ned).cwiseAbs().maxCoeff() < distance &&
         std::min((q_a - q_b).cwiseAbs().maxCoeff(), (q_a + q_b).cwiseAbs().maxCoeff()) < distance;
}

}  // namespace

void StuckPoseDetector::update(const plant::PoseSample& pose, plant::RotorState rotors) {
  const bool again = last_.tracked && closer(pose, last_, settings_.same);
  const bool distinct = last_.tracked && !closer(pose, last_, settings_.distinct);
  repetitions_ = again ? std::min(repetitions_ + 1, settings_.repetitions) : 0;
  last_ = pose;
  if (rotors != plant::RotorState::kOff) return;
  distinct_ = distinct ? std::min(distinct_ + 1, settings_.distinct_poses) : 0;
  if (distinct_ == settings_.distinct_poses) noisy_ = true;
}

void PoseContinuity::update(const plant::PoseSample& pose) {
  bool stepped = next_ == 0;
  if (next_ > 0) {
    const plant::PoseSample& last = before(0);
    interval_s_ = static_cast<double>(pose.stamp_ns - last.stamp_ns) * 1e-9;
    const Eigen::Vector3d moved_ned = pose.position_ned - last.position_ned;
    const Eigen::Quaterniond turned_frd = last.q_ned_from_frd.conjugate() * pose.q_ned_from_frd;
    const double reach_m = max_speed_ * interval_s_ + settings_.noise_m;
    const double reach_rad = max_body_rate_ * interval_s_ + settings_.noise_rad;
    stepped = moved_ned.norm() > reach_m || math::rotation_vector(turned_frd).norm() > reach_rad;
    if (stepped && rejected_) {
      rejected_ = false;
      in_reach_ = true;
      stepped_ned_.setZero();
      turned_frd_.setIdentity();
    } else if (stepped) {
      stepped_ned_ += moved_ned;
      turned_frd_ = (turned_frd_ * turned_frd).normalized();
      // The allowance is twice the reach: once for the step away, once for the step back.
      in_reach_ =
          stepped_ned_.norm() < 2.0 * reach_m && math::rotation_vector(turned_frd_).norm() < 2.0 * reach_rad;
    }
    if (interval_s_ > settings_.longest_gap_s) unbroken_ = false;
  }
  poses_ = stepped ? 1 : poses_ + 1;
  if (stepped) since_ns_ = pose.stamp_ns;
  last_[next_++ % last_.size()] = pose;
}

Eigen::Vector3d PoseContinuity::velocity_ned() const {
  if (next_ < last_.size()) return Eigen::Vector3d::Zero();
  const plant::PoseSample& from = before(kSpan);
  const double dt = static_cast<double>(before(0).stamp_ns - from.stamp_ns) * 1e-9;
  return (before(0).position_ned - from.position_ned) / dt;
}

}  // namespace swiftlet::control

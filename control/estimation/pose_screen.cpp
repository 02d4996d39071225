#include "swiftlet/control/estimation/pose_screen.hpp"

#include <algorithm>

#include "swiftlet/math/rotation_vector.hpp"

namespace swiftlet::control {
namespace {

constexpr double kSame = 1e-8;
constexpr double kDistinct = 2e-6;  // more than the last bits of what has come to rest
constexpr int kDistinctPoses = 20;  // that show that a stream has noise
constexpr double kLongestGap_s = 0.1;
constexpr double kFastest = 4.0;       // m/s, of a vehicle between two poses ...
constexpr double kFastestTurn = 6.0;   // rad/s
constexpr double kSmallStep_m = 0.01;  // ... and what noise may add
constexpr double kSmallStep_rad = 0.01;

// No component differs by as much, of the position in m or of the quaternion, of which q and -q are the same.
bool closer(const plant::PoseSample& a, const plant::PoseSample& b, double distance) {
  const double sign = a.q_ned_from_frd.dot(b.q_ned_from_frd) < 0.0 ? -1.0 : 1.0;
  return (a.position_ned - b.position_ned).cwiseAbs().maxCoeff() < distance &&
         (a.q_ned_from_frd.coeffs() - sign * b.q_ned_from_frd.coeffs()).cwiseAbs().maxCoeff() < distance;
}

}  // namespace

void RepetitionWatch::look_at(const plant::PoseSample& pose, plant::RotorState rotors) {
  const bool again = last_.tracked && closer(pose, last_, kSame);
  const bool distinct = last_.tracked && !closer(pose, last_, kDistinct);
  repetitions_ = again ? std::min(repetitions_ + 1, kRepetitions) : 0;
  last_ = pose;
  if (rotors != plant::RotorState::kOff) return;
  distinct_ = distinct ? std::min(distinct_ + 1, kDistinctPoses) : 0;
  if (distinct_ == kDistinctPoses) noisy_ = true;
}

void Continuity::look_at(const plant::PoseSample& pose) {
  bool stepped = next_ == 0;
  if (next_ > 0) {
    const plant::PoseSample& last = before(0);
    interval_s_ = static_cast<double>(pose.stamp_ns - last.stamp_ns) * 1e-9;
    const Eigen::Vector3d moved_ned = pose.position_ned - last.position_ned;
    const Eigen::Quaterniond turned_frd = last.q_ned_from_frd.conjugate() * pose.q_ned_from_frd;
    const double reach_m = kFastest * interval_s_ + kSmallStep_m;
    const double reach_rad = kFastestTurn * interval_s_ + kSmallStep_rad;
    stepped = moved_ned.norm() > reach_m || plant::rotation_vector(turned_frd).norm() > reach_rad;
    if (stepped && disowned_) {
      disowned_ = false;
      in_reach_ = true;
      stepped_ned_.setZero();
      turned_frd_.setIdentity();
    } else if (stepped) {
      stepped_ned_ += moved_ned;
      turned_frd_ = (turned_frd_ * turned_frd).normalized();
      // Within what the body has moved by itself, in the step away and in the step back.
      in_reach_ =
          stepped_ned_.norm() < 2.0 * reach_m && plant::rotation_vector(turned_frd_).norm() < 2.0 * reach_rad;
    }
    if (interval_s_ > kLongestGap_s) unbroken_ = false;
  }
  poses_ = stepped ? 1 : poses_ + 1;
  if (stepped) since_ns_ = pose.stamp_ns;
  last_[next_++ % last_.size()] = pose;
}

Eigen::Vector3d Continuity::velocity_ned() const {
  if (next_ < last_.size()) return Eigen::Vector3d::Zero();
  const plant::PoseSample& from = before(kSpan);
  const double dt = static_cast<double>(before(0).stamp_ns - from.stamp_ns) * 1e-9;
  return (before(0).position_ned - from.position_ned) / dt;
}

}  // namespace swiftlet::control

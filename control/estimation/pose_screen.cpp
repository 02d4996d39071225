#include "control/estimation/pose_screen.hpp"

#include <algorithm>

#include "control/estimation/rotation_vector.hpp"

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
constexpr double kScatter_m = 0.03;
constexpr double kScatter_rad = 0.1;

// No component differs by as much, of the position in m or of the quaternion.
bool closer(const plant::PoseSample& a, const plant::PoseSample& b, double distance) {
  return (a.position_ned - b.position_ned).cwiseAbs().maxCoeff() < distance &&
         (a.q_ned_from_frd.coeffs() - b.q_ned_from_frd.coeffs()).cwiseAbs().maxCoeff() < distance;
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
  if (next_ > 0) {
    const plant::PoseSample& last = before(0);
    const double dt = interval_s_ = static_cast<double>(pose.stamp_ns - last.stamp_ns) * 1e-9;
    const double moved = (pose.position_ned - last.position_ned).norm();
    const double turned = rotation_vector(pose.q_ned_from_frd * last.q_ned_from_frd.conjugate()).norm();
    if (moved > kFastest * dt + kSmallStep_m || turned > kFastestTurn * dt + kSmallStep_rad)
      in_reach_ = false;
    if (dt > kLongestGap_s || !in_reach_) unbroken_ = false;
  }
  last_[next_++ % last_.size()] = pose;
}

Eigen::Vector3d Continuity::velocity_ned() const {
  if (next_ < last_.size()) return Eigen::Vector3d::Zero();
  const plant::PoseSample& from = before(kSpan);
  const double dt = static_cast<double>(before(0).stamp_ns - from.stamp_ns) * 1e-9;
  return (before(0).position_ned - from.position_ned) / dt;
}

void Disagreement::add(std::int64_t stamp_ns, const PoseInnovation& innovation, double max_drift) {
  const double elapsed_s = static_cast<double>(stamp_ns - first_stamp_ns_) * 1e-9;
  const bool goes_on =
      count_ > 0 && (innovation.position - first_.position).norm() < kScatter_m + max_drift * elapsed_s &&
      rotation_vector(rotation(innovation.rotation) * rotation(first_.rotation).conjugate()).norm() <
          kScatter_rad;
  stamp_ns_ = stamp_ns;
  if (goes_on) {
    ++count_;
    return;
  }
  count_ = 1;
  first_stamp_ns_ = stamp_ns;
  first_ = innovation;
}

}  // namespace swiftlet::control

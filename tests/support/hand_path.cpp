#include "tests/support/hand_path.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::tests {
namespace {

using ground::HandStep;

constexpr double kMotion_s = 0.8;
constexpr double kWave_s = 4.0;
constexpr double kDifference_s = 1e-3;

// From 0 to 1 with velocity and acceleration 0 at both ends.
double smooth(double part) {
  const double u = std::clamp(part, 0.0, 1.0);
  return u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

Eigen::Vector3d wave(double time_s) {
  const double fade = smooth(time_s / 0.5) * smooth((kWave_s - time_s) / 0.5);
  return fade * Eigen::Vector3d(0.9 * std::sin(8.0 * time_s), 0.8 * std::sin(10.0 * time_s),
                                1.0 * std::sin(6.5 * time_s));
}

// The rotation that levels a pose and keeps its heading.
Eigen::Vector3d levelling(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d nose = q * Eigen::Vector3d::UnitX();
  const Eigen::Quaterniond level(Eigen::AngleAxisd(std::atan2(nose.y(), nose.x()), Eigen::Vector3d::UnitZ()));
  return math::rotation_vector(q.conjugate() * level);
}

}  // namespace

HandPose HandPath::Motion::at(double time_s) const {
  const double part = smooth((time_s - begin_s) / duration_s);
  const Eigen::Vector3d turn =
      waves ? wave(std::clamp(time_s - begin_s, 0.0, duration_s)) : Eigen::Vector3d(part * turned_frd);
  return {from.position_ned + part * moved_ned, from.q_ned_from_frd * math::rotation(turn)};
}

double HandPath::move(HandStep step, double begin_s) {
  Motion motion;
  motion.begin_s = begin_s;
  motion.duration_s = step == HandStep::kWave ? kWave_s : kMotion_s;
  motion.waves = step == HandStep::kWave;
  motion.from = at(begin_s);
  switch (step) {
    case HandStep::kRollRight:
      motion.turned_frd = {0.8, 0.0, 0.0};
      break;
    case HandStep::kNoseUp:
      motion.turned_frd = {0.0, 0.8, 0.0};
      break;
    case HandStep::kTurnRight:
      motion.turned_frd = {0.0, 0.0, 1.4};
      break;
    case HandStep::kForward:
      motion.moved_ned = motion.from.q_ned_from_frd * Eigen::Vector3d(0.5, 0.0, 0.0);
      break;
    case HandStep::kUp:
      motion.moved_ned = {0.0, 0.0, -0.5};
      break;
    case HandStep::kWave:
      break;
    case HandStep::kBack:
      motion.turned_frd = levelling(motion.from.q_ned_from_frd);
      break;
  }
  motions_.push_back(motion);
  return begin_s + motion.duration_s;
}

HandPose HandPath::at(double time_s) const {
  const auto after = std::find_if(motions_.rbegin(), motions_.rend(),
                                  [&](const Motion& motion) { return motion.begin_s <= time_s; });
  return after == motions_.rend() ? start_ : after->at(time_s);
}

Eigen::Vector3d HandPath::body_rates_frd(double time_s) const {
  const Eigen::Quaterniond before = at(time_s - kDifference_s).q_ned_from_frd;
  const Eigen::Quaterniond after = at(time_s + kDifference_s).q_ned_from_frd;
  return math::rotation_vector(before.conjugate() * after) / (2.0 * kDifference_s);
}

Eigen::Vector3d HandPath::specific_force_frd(double time_s) const {
  const HandPose now = at(time_s);
  const Eigen::Vector3d acceleration_ned = (at(time_s - kDifference_s).position_ned - 2.0 * now.position_ned +
                                            at(time_s + kDifference_s).position_ned) /
                                           (kDifference_s * kDifference_s);
  return now.q_ned_from_frd.conjugate() * (acceleration_ned - Eigen::Vector3d(0.0, 0.0, plant::kGravity));
}

}  // namespace swiftlet::tests

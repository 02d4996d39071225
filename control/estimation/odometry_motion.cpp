#include "swiftlet/control/estimation/odometry_motion.hpp"

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kCloseStamps = 1.0 / 3.0;  // of the usual interval
constexpr double kIntervalGain = 0.05;      // of each sample
constexpr double kStandingThrust = 0.5;     // of the weight: with less the vehicle stands

Vector3d force_at_rest(const Quaterniond& q_ned_from_frd) {
  return q_ned_from_frd.conjugate() * Vector3d(0.0, 0.0, -plant::kGravity);
}

}  // namespace

MeanMotion OdometryMotion::step(const plant::OdometrySample& sample, double specific_thrust) {
  MeanMotion motion;
  const bool jumped = has_last_ && sample.resets != last_.resets;
  const double dt_s = math::seconds(sample.stamp_ns - last_.stamp_ns);
  const bool too_close = has_last_ && !jumped && dt_s < kCloseStamps * interval_s_;
  motion.specific_force_frd = jumped || too_close ? last_force_frd_ : specific_force(sample, specific_thrust);
  motion.body_rates_frd =
      has_last_ ? Vector3d(0.5 * (last_.body_rates_frd + sample.body_rates_frd)) : sample.body_rates_frd;
  if (has_last_ && !jumped && !too_close && dt_s > 0.0)
    motion.body_rates_frd =
        math::rotation_vector(last_.q_ned_from_frd.conjugate() * sample.q_ned_from_frd) / dt_s;
  if (has_last_ && dt_s > 0.0)
    interval_s_ = interval_s_ == 0.0 ? dt_s : interval_s_ + kIntervalGain * (dt_s - interval_s_);
  last_force_frd_ = motion.specific_force_frd;
  if (too_close) return motion;
  last_ = sample;
  has_last_ = true;
  return motion;
}

Vector3d OdometryMotion::specific_force(const plant::OdometrySample& sample, double specific_thrust) const {
  const double dt_s = math::seconds(sample.stamp_ns - last_.stamp_ns);
  const bool velocity_known = sample.velocity_valid && last_.velocity_valid && dt_s > 0.0;
  if (has_last_ && velocity_known) {
    const Quaterniond q_mid = last_.q_ned_from_frd.slerp(0.5, sample.q_ned_from_frd);
    const Vector3d acceleration_ned = (sample.velocity_ned - last_.velocity_ned) / dt_s;
    return q_mid.conjugate() * (acceleration_ned - Vector3d(0.0, 0.0, plant::kGravity));
  }
  if (specific_thrust < kStandingThrust * plant::kGravity || sample.velocity_valid)
    return force_at_rest(sample.q_ned_from_frd);
  return {0.0, 0.0, -specific_thrust};
}

}  // namespace swiftlet::control

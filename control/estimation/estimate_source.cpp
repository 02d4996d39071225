#include "swiftlet/control/estimation/estimate_source.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "swiftlet/math/euler.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond about_down(double angle_rad) {
  return Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()));
}

// The turn about down by which the heading of `to` differs from that of `from`, rad, within -pi .. pi.
double heading_between(const Quaterniond& from, const Quaterniond& to) {
  const double yaw = math::euler_angles(to).heading.yaw_rad - math::euler_angles(from).heading.yaw_rad;
  return std::remainder(yaw, 2.0 * M_PI);
}

double towards_zero(double value, double step) {
  return value > 0.0 ? std::max(value - step, 0.0) : std::min(value + step, 0.0);
}

}  // namespace

EstimateSource::EstimateSource(const OdometrySettings& settings, double mocap_timeout_s)
    : settings_(settings),
      lost_after_s_(0.5 * mocap_timeout_s),
      position_age_s_(std::numeric_limits<double>::infinity()) {}

void EstimateSource::update(const plant::OdometrySample& sample, const Vector3d& specific_force_frd,
                            const Estimator& filter, plant::RotorState rotors) {
  const double dt_s = has_sample_ ? math::seconds(sample.stamp_ns - sample_.stamp_ns) : 0.0;
  const bool reset = has_sample_ && sample.resets != sample_.resets;
  if (reset) ++resets_followed_;
  if (sample.position_valid) valid_ns_ = sample.stamp_ns;
  const Source chosen = choose(sample, filter, rotors);
  const bool of_vehicle = chosen == Source::kVehicle;
  const Estimate& fused = filter.estimate();
  const Motion source = of_vehicle ? motion_of_vehicle(sample, specific_force_frd, dt_s)
                                   : Motion{fused.position_ned, fused.velocity_ned, fused.q_ned_from_frd};
  const bool switched = chosen != source_;
  if (!of_vehicle && !switched) now_.resets += fused.resets - filter_resets_;
  filter_resets_ = fused.resets;
  source_ = chosen;

  const bool had_estimate = has_estimate_;
  has_estimate_ = of_vehicle ? valid_ns_ >= 0 : filter.initialised();
  if (!had_estimate) {
    now_.position_ned = source.position_ned;
    heading_rad_ = 0.0;
    velocity_rest_ned_.setZero();
  } else {
    go_on(source, specific_force_frd, switched || (of_vehicle && reset), dt_s);
    const bool holds = of_vehicle && settings_.use == OdometryUse::kBoth;
    if (!holds) glide(source, rotors == plant::RotorState::kOff, dt_s);
  }
  const Quaterniond turn = about_down(heading_rad_);
  now_.stamp_ns = sample.stamp_ns;
  now_.velocity_ned = turn * source.velocity_ned + velocity_rest_ned_;
  now_.q_ned_from_frd = turn * source.q_ned_from_frd;
  now_.body_rates_frd = of_vehicle ? sample.body_rates_frd : fused.body_rates_frd;
  now_.gyro_bias = of_vehicle ? Vector3d(Vector3d::Zero()) : fused.gyro_bias;
  now_.accelerometer_bias = of_vehicle ? Vector3d(Vector3d::Zero()) : fused.accelerometer_bias;
  now_.pose_fault = of_vehicle ? PoseFault::kNone : fused.pose_fault;
  now_.poses_accepted = fused.poses_accepted;
  now_.poses_refused = fused.poses_refused;
  now_.reset_position_ned = fused.reset_position_ned;
  now_.reset_rotation_ned = fused.reset_rotation_ned;
  last_ = source;
  position_age_s_ = of_vehicle ? age_of_vehicle_s(sample, filter) : filter.pose_age_s();
  heading_to_vehicle_rad_ = has_estimate_ ? heading_between(now_.q_ned_from_frd, sample.q_ned_from_frd) : 0.0;
  sample_ = sample;
  has_sample_ = true;
  compare(sample, filter);
}

// A position that the vehicle takes from our poses is no newer than the last of them, whatever the vehicle says.
double EstimateSource::age_of_vehicle_s(const plant::OdometrySample& sample, const Estimator& filter) const {
  const double age_s =
      valid_ns_ >= 0 ? math::seconds(sample.stamp_ns - valid_ns_) : std::numeric_limits<double>::infinity();
  return sample.fuses_mocap ? std::max(age_s, filter.pose_age_s()) : age_s;
}

EstimateSource::Source EstimateSource::choose(const plant::OdometrySample& sample, const Estimator& filter,
                                              plant::RotorState rotors) {
  if (settings_.use == OdometryUse::kMocap) return Source::kMocap;
  if (settings_.use == OdometryUse::kVehicle) return Source::kVehicle;
  const bool fresh = filter.pose_age_s() <= lost_after_s_;
  if (!fresh) steady_since_ns_ = -1;
  if (fresh && steady_since_ns_ < 0) steady_since_ns_ = sample.stamp_ns;
  const bool steady = fresh && (rotors == plant::RotorState::kOff ||
                                math::seconds(sample.stamp_ns - steady_since_ns_) >= kSteady_s);
  // One that is made from the same poses is lost with them.
  const bool usable = sample.position_valid && sample.velocity_valid && !sample.fuses_mocap;
  if (source_ == Source::kVehicle) return steady || !usable ? Source::kMocap : Source::kVehicle;
  return !fresh && usable ? Source::kVehicle : Source::kMocap;
}

// What the vehicle does not know goes on from the last sample: its velocity by the specific force, its position by the
// velocity.
EstimateSource::Motion EstimateSource::motion_of_vehicle(const plant::OdometrySample& sample,
                                                         const Vector3d& specific_force_frd,
                                                         double dt_s) const {
  Motion motion;
  const Quaterniond& q = sample.q_ned_from_frd;
  motion.q_ned_from_frd = q;
  const Vector3d acceleration_ned = q * specific_force_frd + Vector3d(0.0, 0.0, plant::kGravity);
  motion.velocity_ned =
      sample.velocity_valid ? sample.velocity_ned : Vector3d(last_.velocity_ned + dt_s * acceleration_ned);
  motion.position_ned =
      sample.position_valid ? sample.position_ned : Vector3d(last_.position_ned + dt_s * motion.velocity_ned);
  return motion;
}

// Moves the estimate as the source has moved since the last sample; over a jump, with the specific force and the rates.
void EstimateSource::go_on(const Motion& source, const Vector3d& specific_force_frd, bool jumped,
                           double dt_s) {
  if (!jumped) {
    now_.position_ned += about_down(heading_rad_) * (source.position_ned - last_.position_ned);
    return;
  }
  now_.position_ned += dt_s * now_.velocity_ned;
  const Quaterniond expected = now_.q_ned_from_frd * math::rotation(dt_s * now_.body_rates_frd);
  heading_rad_ = heading_between(source.q_ned_from_frd, expected);
  const Vector3d acceleration_ned = expected * specific_force_frd + Vector3d(0.0, 0.0, plant::kGravity);
  velocity_rest_ned_ =
      now_.velocity_ned + dt_s * acceleration_ned - about_down(heading_rad_) * source.velocity_ned;
}

void EstimateSource::glide(const Motion& source, bool settles_at_once, double dt_s) {
  const Vector3d rest = source.position_ned - now_.position_ned;
  const double step = settings_.glide_speed * dt_s;
  const double distance = rest.norm();
  now_.position_ned = settles_at_once || distance <= step
                          ? source.position_ned
                          : Vector3d(now_.position_ned + step / distance * rest);
  heading_rad_ = settles_at_once ? 0.0 : towards_zero(heading_rad_, settings_.glide_yaw_rate * dt_s);
  const double change = settings_.glide_acceleration * dt_s;
  const double speed = velocity_rest_ned_.norm();
  velocity_rest_ned_ *= settles_at_once || speed <= change ? 0.0 : 1.0 - change / speed;
}

void EstimateSource::compare(const plant::OdometrySample& sample, const Estimator& filter) {
  distance_m_ = angle_rad_ = -1.0;
  if (!filter.initialised() || filter.pose_age_s() > lost_after_s_) return;
  const Estimate& fused = filter.estimate();
  if (sample.position_valid) distance_m_ = (sample.position_ned - fused.position_ned).norm();
  angle_rad_ = sample.q_ned_from_frd.angularDistance(fused.q_ned_from_frd);
}

ErrorState EstimateSource::standard_deviation(const Estimator& filter) const {
  if (!is_vehicles()) return filter.standard_deviation();
  ErrorState deviation = ErrorState::Zero();
  deviation.segment<3>(0) = sample_.position_deviation;
  deviation.segment<3>(3) = sample_.velocity_deviation;
  deviation.segment<3>(6) = sample_.rotation_deviation;
  return deviation;
}

Vector3d EstimateSource::position_in_vehicle(const Vector3d& position_ned) const {
  if (!has_estimate_ || !sample_.position_valid) return position_ned;
  return sample_.position_ned + about_down(heading_to_vehicle_rad_) * (position_ned - now_.position_ned);
}

}  // namespace swiftlet::control

#include "control/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMaxStep_s = 0.1;          // longer gaps between IMU samples are not integrated over
constexpr double kMaxPoseInterval_s = 0.1;  // the gains do not grow beyond this interval
constexpr double kGate_m = 0.3;             // innovation that is believed at once ...
constexpr double kGateGrowth_m_s = 1.0;     // ... and how it widens with the age of the last pose
constexpr double kGate_rad = 0.5;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

// The unit quaternion of a rotation vector: (cos h, sin(h) / h * half), h being the length of half the
// vector. Small ones, as of every step, by series whose first term left out is below 1e-16.
Quaterniond rotation(const Vector3d& angle) {
  constexpr double kLargestForSeries = 0.01;  // h^2
  const Vector3d half = 0.5 * angle;
  const double h2 = half.squaredNorm();
  double cosine =
      1.0 - 0.5 * h2 * (1.0 - (1.0 / 12) * h2 * (1.0 - (1.0 / 30) * h2 * (1.0 - (1.0 / 56) * h2)));
  double sine_over_h =
      1.0 - (1.0 / 6) * h2 * (1.0 - (1.0 / 20) * h2 * (1.0 - (1.0 / 42) * h2 * (1.0 - (1.0 / 72) * h2)));
  if (h2 > kLargestForSeries) {
    const double h = std::sqrt(h2);
    cosine = std::cos(h);
    sine_over_h = std::sin(h) / h;
  }
  return Quaterniond(cosine, sine_over_h * half.x(), sine_over_h * half.y(), sine_over_h * half.z());
}

// The rotation vector of a unit quaternion near identity.
Vector3d small_angle(const Quaterniond& q) { return (q.w() < 0.0 ? -2.0 : 2.0) * q.vec(); }

Vector3d bounded(const Vector3d& v, double limit) { return v.cwiseMax(-limit).cwiseMin(limit); }

}  // namespace

Estimator::Estimator(const EstimatorSettings& settings) : settings_(settings) {}

double Estimator::pose_age_s() const {
  return initialised_ ? seconds(now_.stamp_ns - pose_stamp_ns_) : std::numeric_limits<double>::infinity();
}

bool Estimator::predict(const plant::ImuSample& sample) {
  if (!sample.specific_force_frd.allFinite() || !sample.body_rates_frd.allFinite()) return false;
  if (sample.stamp_ns <= last_imu_.stamp_ns) return false;

  const bool first = last_imu_.stamp_ns == 0;
  const double dt = first ? 0.0 : std::min(seconds(sample.stamp_ns - last_imu_.stamp_ns), kMaxStep_s);
  const plant::ImuSample& before = first ? sample : last_imu_;
  now_.stamp_ns = sample.stamp_ns;
  now_.body_rates_frd = sample.body_rates_frd - now_.gyro_bias;

  if (initialised_) {
    const Vector3d mean_rates = 0.5 * (before.body_rates_frd + sample.body_rates_frd) - now_.gyro_bias;
    const Vector3d mean_force =
        0.5 * (before.specific_force_frd + sample.specific_force_frd) - now_.accelerometer_bias;
    const Quaterniond half_turn = rotation(0.5 * dt * mean_rates);
    const Quaterniond q_mid = now_.q_ned_from_frd * half_turn;
    const Vector3d acceleration = q_mid * mean_force + Vector3d(0.0, 0.0, plant::kGravity);
    now_.position_ned += dt * now_.velocity_ned + (0.5 * dt * dt) * acceleration;
    now_.velocity_ned += dt * acceleration;
    now_.q_ned_from_frd = (q_mid * half_turn).normalized();
    remember();
  }
  last_imu_ = sample;
  return true;
}

bool Estimator::correct(const plant::PoseSample& pose) {
  if (!pose.tracked || !pose.position_ned.allFinite() || !pose.q_ned_from_frd.coeffs().allFinite())
    return false;
  if (std::abs(pose.q_ned_from_frd.norm() - 1.0) > 0.01) return false;
  if (pose.stamp_ns <= pose_stamp_ns_ || now_.stamp_ns == 0) return false;
  if (!initialised_) {
    start_at(pose);
    return true;
  }

  int newer = -1;  // steps back to the oldest entry that is newer than the pose
  while (newer + 1 < filled_ && past(newer + 1).stamp_ns > pose.stamp_ns) ++newer;
  if (newer + 1 == filled_) return false;
  const Past& before = past(newer + 1);
  Vector3d position = before.position_ned;
  Quaterniond q = before.q_ned_from_frd;
  if (newer >= 0 && before.stamp_ns < pose.stamp_ns) {
    const Past& after = past(newer);
    const double part = seconds(pose.stamp_ns - before.stamp_ns) / seconds(after.stamp_ns - before.stamp_ns);
    position += part * (after.position_ned - before.position_ned);
    q = q.slerp(part, after.q_ned_from_frd);
  }

  const Vector3d position_error = pose.position_ned - position;
  const Vector3d angle_error = small_angle(pose.q_ned_from_frd.normalized() * q.conjugate());  // in NED
  const double interval = seconds(pose.stamp_ns - pose_stamp_ns_);
  if (position_error.norm() > kGate_m + kGateGrowth_m_s * interval || angle_error.norm() > kGate_rad) {
    if (++rejections_ < kRejectionsToReset) return false;
    start_at(pose);
    return true;
  }
  rejections_ = 0;
  pose_stamp_ns_ = pose.stamp_ns;
  pose_sequence_ = pose.sequence;

  // Critically damped gains for the interval T, all poles at exp(-bandwidth T).
  const double T = std::min(interval, kMaxPoseInterval_s);
  const double b = std::exp(-settings_.position_bandwidth * T);
  const Vector3d position_step = (1.0 - b * b * b) * position_error;
  const Vector3d velocity_step = (1.5 * (1.0 - b) * (1.0 - b) * (1.0 + b) / T) * position_error;
  const Vector3d acceleration_step = ((1.0 - b) * (1.0 - b) * (1.0 - b) / (T * T)) * position_error;
  const double c = std::exp(-settings_.attitude_bandwidth * T);
  const Vector3d angle_step = (1.0 - c * c) * angle_error;
  const Vector3d rate_step = ((1.0 - c) * (1.0 - c) / T) * angle_error;

  const Quaterniond turn = rotation(angle_step);
  for (int k = newer; k >= 0; --k) {
    Past& entry = past(k);
    entry.position_ned += position_step + seconds(entry.stamp_ns - pose.stamp_ns) * velocity_step;
    entry.velocity_ned += velocity_step;
    entry.q_ned_from_frd = turn * entry.q_ned_from_frd;
  }
  now_.position_ned += position_step + seconds(now_.stamp_ns - pose.stamp_ns) * velocity_step;
  now_.velocity_ned += velocity_step;
  now_.q_ned_from_frd = (turn * now_.q_ned_from_frd).normalized();

  const Quaterniond q_frd_from_ned = now_.q_ned_from_frd.conjugate();
  now_.accelerometer_bias = bounded(now_.accelerometer_bias - q_frd_from_ned * acceleration_step,
                                    settings_.accelerometer_bias_limit);
  const Vector3d gyro_bias = bounded(now_.gyro_bias - q_frd_from_ned * rate_step, settings_.gyro_bias_limit);
  now_.body_rates_frd += now_.gyro_bias - gyro_bias;
  now_.gyro_bias = gyro_bias;
  return true;
}

void Estimator::start_at(const plant::PoseSample& pose) {
  now_.position_ned = pose.position_ned;
  now_.velocity_ned.setZero();
  now_.q_ned_from_frd = pose.q_ned_from_frd.normalized();
  now_.accelerometer_bias.setZero();
  initialised_ = true;
  pose_stamp_ns_ = pose.stamp_ns;
  pose_sequence_ = pose.sequence;
  rejections_ = 0;
  filled_ = 0;
  remember();
}

void Estimator::remember() {
  head_ = (head_ + 1) % kHistory;
  filled_ = std::min(filled_ + 1, kHistory);
  past(0) = {now_.stamp_ns, now_.position_ned, now_.velocity_ned, now_.q_ned_from_frd};
}

}  // namespace swiftlet::control

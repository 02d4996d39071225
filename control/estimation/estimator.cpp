#include "swiftlet/control/estimation/estimator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kUnitTolerance = 0.01;  // allowed deviation of a quaternion's length from 1
constexpr double kMaxFallSpeed = 1e3;    // m/s before the first pose; above it precision is lost

double squared(double x) { return x * x; }

Vector3d bounded(const Vector3d& v, double limit) { return v.cwiseMax(-limit).cwiseMin(limit); }

}  // namespace

const char* to_string(PoseFault fault) {
  switch (fault) {
    case PoseFault::kNone:
      return "none";
    case PoseFault::kUntracked:
      return "untracked";
    case PoseFault::kInvalid:
      return "invalid";
    case PoseFault::kUntimely:
      return "untimely";
    case PoseFault::kOutlier:
      return "outlier";
    case PoseFault::kSwapped:
      return "swapped";
    case PoseFault::kFrozen:
      return "frozen";
  }
  return "unknown";
}

Estimator::Estimator(const EstimatorSettings& settings)
    : settings_(settings),
      detectors_(settings.detectors),
      stuck_pose_(settings.detectors.stuck_pose),
      continuity_(settings) {
  noise_.velocity = squared(settings.accelerometer_noise_density);
  noise_.rotation = squared(settings.gyro_noise_density);
  noise_.gyro_bias = squared(settings.gyro_bias_walk);
  noise_.accelerometer_bias = squared(settings.accelerometer_bias_walk);
}

double Estimator::pose_age_s() const {
  return initialised_ ? math::seconds(now_.stamp_ns - pose_stamp_ns_)
                      : std::numeric_limits<double>::infinity();
}

bool Estimator::is_usable(const plant::ImuSample& sample) const {
  return sample.specific_force_frd.allFinite() && sample.body_rates_frd.allFinite() &&
         sample.stamp_ns > last_imu_.stamp_ns;
}

bool Estimator::predict(const plant::ImuSample& sample) {
  const plant::ImuSample& before = last_imu_.stamp_ns == 0 ? sample : last_imu_;
  return predict(sample, {0.5 * (before.specific_force_frd + sample.specific_force_frd),
                          0.5 * (before.body_rates_frd + sample.body_rates_frd)});
}

bool Estimator::predict(const plant::ImuSample& sample, const MeanMotion& mean) {
  if (!is_usable(sample)) return false;
  const bool first = last_imu_.stamp_ns == 0;
  const double dt =
      first ? 0.0
            : std::min(math::seconds(sample.stamp_ns - last_imu_.stamp_ns), detectors_.imu_silence.longest_s);
  if (dt > detectors_.imu_silence.from_s) {
    imu_was_silent_ = true;
    silence_end_ns_ = sample.stamp_ns;
    pose_imu_test_.begin();
  }
  now_.stamp_ns = sample.stamp_ns;
  now_.body_rates_frd = sample.body_rates_frd - now_.gyro_bias;

  // Sola's Eq. (260a)-(260c), v <- v + (R a + g) dt, q <- q rotation(w dt), with the means between the two samples
  const Vector3d mean_rates = mean.body_rates_frd - now_.gyro_bias;
  const Vector3d mean_force = mean.specific_force_frd - now_.accelerometer_bias;
  const Quaterniond half_turn = math::rotation(0.5 * dt * mean_rates);
  NominalState state = history_.newest();
  const Quaterniond q_mid = state.q_ned_from_frd * half_turn;
  const Vector3d acceleration = q_mid * mean_force + Vector3d(0.0, 0.0, plant::kGravity);
  state.stamp_ns = sample.stamp_ns;
  state.position_ned += dt * state.velocity_ned + (0.5 * dt * dt) * acceleration;
  state.velocity_ned += dt * acceleration;
  state.q_ned_from_frd = math::renormalised(q_mid * half_turn);
  if (initialised_) {
    history_.make_room([this](const ErrorInterval& interval) { propagate(covariance_, interval); });
  } else if (state.velocity_ned.norm() > kMaxFallSpeed) {  // restart: the start is arbitrary
    state.position_ned.setZero();
    state.velocity_ned.setZero();
    history_.clear();
  }
  history_.append(state);
  if (initialised_) publish();
  last_imu_ = sample;
  return true;
}

bool Estimator::correct(const plant::PoseSample& pose, plant::RotorState rotors) {
  if (pose.stamp_ns == received_stamp_ns_ && received_stamp_ns_ != 0) return false;
  received_stamp_ns_ = pose.stamp_ns;
  now_.pose_fault = fuse(pose, rotors);
  const bool accepted = now_.pose_fault == PoseFault::kNone;
  ++(accepted ? now_.poses_accepted : now_.poses_refused);
  return accepted;
}

PoseFault Estimator::fuse(const plant::PoseSample& pose, plant::RotorState rotors) {
  if (!pose.tracked) return PoseFault::kUntracked;
  if (!pose.position_ned.allFinite() || !pose.q_ned_from_frd.coeffs().allFinite()) return PoseFault::kInvalid;
  if (std::abs(pose.q_ned_from_frd.norm() - 1.0) > kUnitTolerance) return PoseFault::kInvalid;
  if (now_.stamp_ns == 0) return PoseFault::kUntimely;
  if (pose.stamp_ns >
      now_.stamp_ns + math::nanoseconds(detectors_.recovery.max_lead_s)) {  // the IMU is silent
    continuity_.update(pose);
    return PoseFault::kUntimely;
  }
  if (initialised_ && (pose.stamp_ns <= pose_stamp_ns_ || pose.stamp_ns < history_.anchor().stamp_ns))
    return PoseFault::kUntimely;
  stuck_pose_.update(pose, rotors);
  continuity_.update(pose);
  if (!initialised_) {
    start_at(pose);
    return PoseFault::kNone;
  }

  const PoseInnovation innovation = compare(pose);
  const ErrorCovariance::Update correction = compute_update(innovation);
  normalised_innovation_ = correction.normalised_square();
  const bool contradicts = normalised_innovation_ > settings_.gate_chi_square;
  // A stream without noise repeats its pose while the vehicle stands: with the rotors off it is not stuck.
  const bool stuck = contradicts && stuck_pose_.repeats() && rotors != plant::RotorState::kOff;
  if (stuck_pose_.frozen() || stuck) return PoseFault::kFrozen;
  const bool trusted = rotors == plant::RotorState::kOff || trusted_after_silence(pose, innovation);
  const bool far_off = innovation.position.norm() > settings_.outlier_position_m ||
                       innovation.rotation.norm() > outlier_rotation();
  if (!trusted || (contradicts && far_off)) return disagree(pose, innovation, rotors, trusted);

  accept(pose);
  contradictions_ = contradicts ? contradictions_ + 1 : 0;
  if (contradicts && contradictions_ <= detectors_.recovery.glitch_poses) {
    apply(std::sqrt(settings_.gate_chi_square / normalised_innovation_) * correction.step());
  } else {
    agree(innovation, correction);
  }
  return PoseFault::kNone;
}

// z = y - h(x) of Sola's Eq. (275) at the pose's own stamp, to which the covariance is propagated.
PoseInnovation Estimator::compare(const plant::PoseSample& pose) {
  history_.move_anchor(pose.stamp_ns,
                       [this](const ErrorInterval& interval) { propagate(covariance_, interval); });
  const NominalState& then = history_.anchor();

  // A pose ahead of the IMU is compared with the extrapolated estimate.
  const double ahead_s = math::seconds(pose.stamp_ns - then.stamp_ns);
  const Quaterniond q_ned_from_frd = then.q_ned_from_frd * math::rotation(ahead_s * now_.body_rates_frd);
  PoseInnovation innovation;
  innovation.position = pose.position_ned - (then.position_ned + ahead_s * then.velocity_ned);
  innovation.rotation = math::rotation_vector(pose.q_ned_from_frd.normalized() * q_ned_from_frd.conjugate());
  return innovation;
}

void Estimator::accept(const plant::PoseSample& pose) {
  continuity_.begin();
  imu_was_silent_ = false;
  refused_in_a_row_ = 0;
  pose_stamp_ns_ = pose.stamp_ns;
  pose_sequence_ = pose.sequence;
}

void Estimator::agree(const PoseInnovation& innovation, const ErrorCovariance::Update& correction) {
  if (contradictions_ == 0) {
    covariance_.apply_update(correction);
    apply(correction.step());
    return;
  }
  const double step_m2 = innovation.position.squaredNorm();
  covariance_.add_motion(step_m2, step_m2 / squared(detectors_.recovery.step_time_s),
                         innovation.rotation.squaredNorm());
  const ErrorCovariance::Update likely = compute_update(innovation);
  covariance_.apply_update(likely);
  apply(likely.step());
}

ErrorCovariance::Update Estimator::compute_update(const PoseInnovation& innovation) const {
  return covariance_.compute_update(innovation, squared(settings_.mocap_position_sigma),
                                    squared(settings_.mocap_orientation_sigma));
}

// A rotation between two poses beyond the largest gyro error did not happen.
double Estimator::outlier_rotation() const {
  const double gyro_slip = 0.5 * settings_.max_body_rate;
  return std::min(settings_.outlier_orientation_rad,
                  detectors_.continuity.noise_rad + gyro_slip * continuity_.interval_s());
}

// After an IMU silence, a pose with a large innovation is trusted only if its stream stayed in reach and its
// motion since agrees with the IMU.
bool Estimator::trusted_after_silence(const plant::PoseSample& pose, const PoseInnovation& innovation) {
  const double turn = std::max(detectors_.imu_silence.turn_rad,
                               detectors_.imu_silence.turn_sigmas * settings_.mocap_orientation_sigma);
  if (!imu_was_silent_ ||
      (innovation.position.norm() < settings_.outlier_position_m && innovation.rotation.norm() < turn))
    return true;
  if (pose.stamp_ns < silence_end_ns_) return false;
  if (continuity_.poses() == 1) pose_imu_test_.begin();
  const PoseImuConsistencyTest::Result result = pose_imu_test_.update(pose, innovation, settings_);
  if (result == PoseImuConsistencyTest::Result::kDisagree && continuity_.in_reach())
    continuity_.reject_track();
  return result == PoseImuConsistencyTest::Result::kAgree && continuity_.in_reach();
}

PoseFault Estimator::disagree(const plant::PoseSample& pose, const PoseInnovation& innovation,
                              plant::RotorState rotors, bool trusted) {
  if (refused_in_a_row_++ == 0) {
    // An IMU error grows from pose to pose. An innovation that appears at once is a jump, unless the IMU was
    // silent.
    const bool sudden =
        innovation.position.norm() > detectors_.recovery.sudden * settings_.outlier_position_m ||
        innovation.rotation.norm() > outlier_rotation();
    if (imu_was_silent_ && continuity_.in_reach()) continuity_.begin();
    if (!imu_was_silent_ && sudden) continuity_.end();
  }
  const bool continuous =
      trusted && continuity_.unbroken() && continuity_.poses() >= detectors_.recovery.poses;
  const bool at_rest = rotors == plant::RotorState::kOff && continuity_.lasting();
  if (refused_in_a_row_ >= detectors_.recovery.poses && (continuous || at_rest)) {
    restart_at(pose, innovation);
    return PoseFault::kNone;
  }
  return innovation.rotation.norm() > detectors_.recovery.swap_rad ? PoseFault::kSwapped
                                                                   : PoseFault::kOutlier;
}

// Applies an error-state step at the anchor to the nominal state, there and since.
void Estimator::apply(const ErrorState& step) {
  history_.apply(step);
  publish();

  const Vector3d gyro_bias = bounded(now_.gyro_bias + step.segment<3>(9), settings_.gyro_bias_limit);
  now_.body_rates_frd += now_.gyro_bias - gyro_bias;
  now_.gyro_bias = gyro_bias;
  now_.accelerometer_bias =
      bounded(now_.accelerometer_bias + step.segment<3>(12), settings_.accelerometer_bias_limit);
}

void Estimator::publish() {
  const NominalState& newest = history_.newest();
  now_.position_ned = newest.position_ned;
  now_.velocity_ned = newest.velocity_ned;
  now_.q_ned_from_frd = newest.q_ned_from_frd;
}

// Resets position, velocity and attitude to a continuous stream of poses.
void Estimator::restart_at(const plant::PoseSample& pose, const PoseInnovation& innovation) {
  ErrorState step = ErrorState::Zero();
  step.segment<3>(0) = innovation.position;
  step.segment<3>(3) = continuity_.velocity_ned() - history_.anchor().velocity_ned;
  step.segment<3>(6) = innovation.rotation;
  apply(step);
  ErrorState sigma;
  sigma << Vector3d::Constant(settings_.mocap_position_sigma), Vector3d::Constant(detectors_.recovery.speed),
      Vector3d::Constant(settings_.mocap_orientation_sigma),
      Vector3d::Constant(detectors_.recovery.gyro_bias),
      Vector3d::Constant(detectors_.recovery.accelerometer_bias);
  covariance_.reset(sigma);
  accept(pose);
  ++now_.resets;
  now_.reset_position_ned = innovation.position;
  now_.reset_rotation_ned = innovation.rotation;
}

// Moves the IMU-propagated path since the pose onto the pose. The vehicle is assumed at rest there, within
// settings.start_speed.
void Estimator::start_at(const plant::PoseSample& pose) {
  history_.begin_at({std::min(pose.stamp_ns, now_.stamp_ns), pose.position_ned, Vector3d::Zero(),
                     pose.q_ned_from_frd.normalized()});
  publish();
  initialised_ = true;
  accept(pose);
  ErrorState sigma;
  sigma << Vector3d::Constant(settings_.mocap_position_sigma), Vector3d::Constant(settings_.start_speed),
      Vector3d::Constant(settings_.mocap_orientation_sigma), Vector3d::Constant(settings_.gyro_bias_sigma),
      Vector3d::Constant(settings_.accelerometer_bias_sigma);
  covariance_.reset(sigma);
}

void Estimator::propagate(ErrorCovariance& covariance, const ErrorInterval& interval) const {
  covariance.advance(interval, noise_);
  const double t = interval.duration_s;
  const ImuSilenceSettings& silence = detectors_.imu_silence;
  if (t <= 1.5 * silence.from_s) return;
  const double speed = silence.acceleration * t;
  covariance.add_motion(squared(0.5 * t * speed), squared(speed), squared(silence.body_rate * t));
}

ErrorCovariance Estimator::covariance() const {
  ErrorCovariance covariance = covariance_;
  if (!initialised_) {
    covariance.reset(ErrorState::Constant(std::numeric_limits<double>::infinity()));
    return covariance;
  }
  history_.for_each_interval([&](const ErrorInterval& interval) { propagate(covariance, interval); });
  return covariance;
}

}  // namespace swiftlet::control

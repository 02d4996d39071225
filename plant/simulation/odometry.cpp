#include "swiftlet/plant/simulation/odometry.hpp"

#include <cmath>

#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::plant {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

Vector4d normal4(math::RandomStream& random) {
  return {random.normal(), random.normal(), random.normal(), random.normal()};
}

Eigen::Quaterniond about_down(double angle_rad) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()));
}

}  // namespace

// The vehicle sets its origin where it starts: the errors begin at 0.
Odometry::Odometry(const SimulationSettings& settings, std::uint64_t seed)
    : settings_(settings.odometry),
      faults_(settings.faults),
      random_(seed, streams::kOdometry),
      sigma_(Vector4d::Constant(settings.odometry.position_drift_m)),
      error_(Vector4d::Zero()),
      error_rate_(Vector4d::Zero()) {
  sigma_[3] = settings.odometry.heading_drift_rad;
}

void Odometry::drift(double dt_s) {
  const double omega = 1.0 / settings_.drift_time_constant_s;
  const double density = 2.0 * omega * std::sqrt(omega * dt_s);  // for a standard deviation of 1
  error_rate_ += dt_s * (-2.0 * omega * error_rate_ - omega * omega * error_) +
                 density * sigma_.cwiseProduct(normal4(random_));
  error_ += dt_s * error_rate_;
}

OdometrySample Odometry::sample(const ImuSample& imu, const VehicleState& truth,
                                const OnboardEstimator& onboard) {
  OdometrySample sample;
  sample.stamp_ns = imu.stamp_ns;
  sample.sequence = imu.sequence;
  sample.body_rates_frd = imu.body_rates_frd;
  sample.fuses_mocap = settings_.source == OdometrySource::kMocap;
  if (sample.fuses_mocap) {
    sample.position_valid = sample.velocity_valid = onboard.initialised();
    sample.position_ned = onboard.position_ned();
    sample.velocity_ned = onboard.velocity_ned();
    sample.q_ned_from_frd = onboard.q_ned_from_frd();
    sample.body_rates_frd = onboard.body_rates_frd();
  } else {
    if (last_ns_ >= 0) drift(1e-9 * static_cast<double>(imu.stamp_ns - last_ns_));
    last_ns_ = imu.stamp_ns;
    const Eigen::Quaterniond turn = about_down(error_[3]);
    const Vector3d turned_ned = turn * truth.position_ned;
    sample.position_valid = sample.velocity_valid = true;
    sample.position_ned = turned_ned + error_.head<3>();
    sample.velocity_ned = turn * truth.velocity_ned + error_rate_[3] * Vector3d::UnitZ().cross(turned_ned) +
                          error_rate_.head<3>();
    sample.q_ned_from_frd = turn * truth.q_ned_from_frd;
    sample.position_deviation.setConstant(sigma_[0]);
    sample.velocity_deviation.setConstant(sigma_[0] / settings_.drift_time_constant_s);
    sample.rotation_deviation.z() = sigma_[3];
  }
  jump(imu.stamp_ns, sample);
  return sample;
}

// During the fault the whole estimate is turned about the origin and moved.
void Odometry::jump(std::int64_t stamp_ns, OdometrySample& sample) {
  const Fault* const fault = faults_.active(FaultKind::kOdometryJump, stamp_ns);
  if (fault != jumped_) ++resets_;
  jumped_ = fault;
  sample.resets = resets_;
  if (fault == nullptr) return;
  const Eigen::Quaterniond turn = about_down(fault->yaw_rad);
  sample.position_ned = turn * sample.position_ned + fault->position_ned;
  sample.velocity_ned = turn * sample.velocity_ned;
  sample.q_ned_from_frd = turn * sample.q_ned_from_frd;
}

}  // namespace swiftlet::plant

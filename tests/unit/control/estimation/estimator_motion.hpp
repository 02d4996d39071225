// A known motion with its sensor samples, for the tests of the estimator.
#pragma once

#include <cmath>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

using math::rotation;
using math::rotation_vector;

constexpr std::int64_t kStep_ns = 2'000'000;
constexpr std::int64_t kFrame_ns = 10'000'000;

// A vehicle on a known path, with its IMU samples.
struct Motion {
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
  Eigen::Vector3d accelerometer_bias = Eigen::Vector3d::Zero();

  static Eigen::Vector3d position(double t) {
    return {std::sin(0.9 * t), 0.5 * std::cos(1.3 * t), -1.0 + 0.2 * std::sin(0.7 * t)};
  }
  static Eigen::Vector3d velocity(double t) {
    return {0.9 * std::cos(0.9 * t), -0.65 * std::sin(1.3 * t), 0.14 * std::cos(0.7 * t)};
  }
  static Eigen::Vector3d acceleration(double t) {
    return {-0.81 * std::sin(0.9 * t), -0.845 * std::cos(1.3 * t), -0.098 * std::sin(0.7 * t)};
  }
  static Eigen::Quaterniond attitude(double t) {
    return Eigen::AngleAxisd(0.4 * std::sin(0.8 * t), Eigen::Vector3d::UnitZ()) *
           Eigen::AngleAxisd(0.2 * std::sin(1.1 * t), Eigen::Vector3d::UnitY()) *
           Eigen::Quaterniond(Eigen::AngleAxisd(0.3 * std::sin(1.7 * t), Eigen::Vector3d::UnitX()));
  }
  plant::ImuSample imu(std::int64_t stamp_ns) const {
    const double t = static_cast<double>(stamp_ns) * 1e-9;
    const double h = 1e-5;
    plant::ImuSample sample;
    sample.stamp_ns = stamp_ns;
    const Eigen::Quaterniond change = attitude(t - h).conjugate() * attitude(t + h);
    sample.body_rates_frd = change.vec() * (change.w() < 0 ? -1.0 : 1.0) / h + gyro_bias;
    sample.specific_force_frd =
        attitude(t).conjugate() * (acceleration(t) - Eigen::Vector3d(0, 0, plant::kGravity)) +
        accelerometer_bias;
    return sample;
  }
  static plant::PoseSample pose(std::int64_t stamp_ns, std::uint64_t sequence) {
    const double t = static_cast<double>(stamp_ns) * 1e-9;
    return {stamp_ns, sequence, true, position(t), attitude(t)};
  }
};

// Adds Gaussian noise with the densities of the settings, and biases with their standard deviations.
class NoisyMotion {
 public:
  NoisyMotion(const EstimatorSettings& settings, std::uint64_t seed) : settings_(settings), noise_(seed, 1) {
    motion_.gyro_bias = settings.gyro_bias_sigma * noise_.normal3();
    motion_.accelerometer_bias = settings.accelerometer_bias_sigma * noise_.normal3();
  }

  // The next sample, kStep_ns after the last.
  plant::ImuSample imu(std::int64_t stamp_ns) {
    const double period = static_cast<double>(kStep_ns) * 1e-9;
    motion_.gyro_bias += settings_.gyro_bias_walk * std::sqrt(period) * noise_.normal3();
    motion_.accelerometer_bias += settings_.accelerometer_bias_walk * std::sqrt(period) * noise_.normal3();
    plant::ImuSample sample = motion_.imu(stamp_ns);
    sample.body_rates_frd += settings_.gyro_noise_density / std::sqrt(period) * noise_.normal3();
    sample.specific_force_frd += settings_.accelerometer_noise_density / std::sqrt(period) * noise_.normal3();
    return sample;
  }
  plant::PoseSample pose(std::int64_t stamp_ns) {
    plant::PoseSample sample = Motion::pose(stamp_ns, ++sequence_);
    sample.position_ned += settings_.mocap_position_sigma * noise_.normal3();
    sample.q_ned_from_frd =
        rotation(settings_.mocap_orientation_sigma * noise_.normal3()) * sample.q_ned_from_frd;
    return sample;
  }
  const Motion& motion() const { return motion_; }  // with the biases of the last sample

  // Truth minus estimate, in the error state of the filter.
  ErrorState error(const Estimate& estimate) const {
    const double t = static_cast<double>(estimate.stamp_ns) * 1e-9;
    ErrorState out;
    out << Motion::position(t) - estimate.position_ned, Motion::velocity(t) - estimate.velocity_ned,
        rotation_vector(Motion::attitude(t) * estimate.q_ned_from_frd.conjugate()),
        motion_.gyro_bias - estimate.gyro_bias, motion_.accelerometer_bias - estimate.accelerometer_bias;
    return out;
  }

 private:
  EstimatorSettings settings_;
  math::RandomStream noise_;
  Motion motion_;
  std::uint64_t sequence_ = 0;
};

}  // namespace swiftlet::control

#include "swiftlet/ground/vehicle_check/rest.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/math/angles.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::ground {
namespace {

using plant::kGravity;

constexpr double kMostRepeated = 0.1;      // of the samples
constexpr double kQuietForce_m_s2 = 0.5;   // standard deviation at rest
constexpr double kGyroNoise_rad_s = 0.05;  // likewise
constexpr double kGyroBias_rad_s = 0.1;
constexpr double kGravityTolerance_m_s2 = 0.5;
constexpr double kMostUntracked = 0.05;
constexpr double kPositionNoise_m = 0.005;

struct Moments {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double deviation = 0.0;  // standard, of the worst axis
};

template <class Value>
Moments moments(std::size_t count, Value value) {
  Moments moments;
  if (count == 0) return moments;
  Eigen::Vector3d square = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) moments.mean += value(i) / static_cast<double>(count);
  for (std::size_t i = 0; i < count; ++i) square += (value(i) - moments.mean).cwiseAbs2();
  moments.deviation = std::sqrt(square.maxCoeff() / static_cast<double>(count));
  return moments;
}

Moments force_moments(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return moments(samples.size(),
                 [&](std::size_t i) -> Eigen::Vector3d { return samples[i].sample.imu.specific_force_frd; });
}
Moments rate_moments(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  return moments(samples.size(),
                 [&](std::size_t i) -> Eigen::Vector3d { return samples[i].sample.imu.body_rates_frd; });
}

CheckResult check_values(const VehicleRecording& recording) {
  const auto& samples = recording.imu.samples;
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    const plant::ImuSample& before = samples[i - 1].sample.imu;
    const plant::ImuSample& now = samples[i].sample.imu;
    if (now.sequence != before.sequence && now.specific_force_frd == before.specific_force_frd &&
        now.body_rates_frd == before.body_rates_frd)
      ++repeated;
  }
  const double part = static_cast<double>(repeated) / static_cast<double>(samples.size() - 1);
  std::string finding;
  if (part > 0.99) {
    finding = "stuck values: no sample differs from the one before";
  } else if (part > kMostRepeated) {
    finding = fmt::format(
        "{:.0f} % of the samples repeat the values of the one before: the sensor is read slower than imu is "
        "published",
        1e2 * part);
  }
  return judged("imu.values", figure(1e2 * part, "%", 1, " repeated bit for bit"),
                fmt::format("at most {:.0f} %", 1e2 * kMostRepeated), finding);
}

CheckResult check_still(const Moments& force) {
  return judged("imu.still", figure(force.deviation, "m/s^2", 3, " standard deviation"),
                fmt::format("at most {:g} m/s^2", kQuietForce_m_s2),
                force.deviation <= kQuietForce_m_s2
                    ? ""
                    : "the vehicle does not stand still with rotors off, or the accelerometer is too noisy");
}

std::string gravity_finding(double size) {
  const auto is_near = [&](double unit) { return std::abs(size / unit - 1.0) < 0.08; };
  const std::string against =
      fmt::format("|specific force| is {:.4g}, expected {:.2f} m/s^2", size, kGravity);
  if (std::abs(size - kGravity) <= kGravityTolerance_m_s2) return "";
  if (size < 0.3) return "the accelerometer does not measure gravity: " + against + "; is it subtracted?";
  if (is_near(1.0)) return "accelerometer in g: " + against;
  if (is_near(1e3)) return "accelerometer in thousandths of g: " + against;
  if (is_near(1e3 * kGravity)) return "accelerometer in mm/s^2: " + against;
  for (const double counts : {2048.0, 4096.0, 8192.0, 16384.0}) {
    if (is_near(counts)) return "accelerometer in counts of a 16-bit sensor: " + against;
  }
  return "accelerometer has a wrong scale or bias: " + against;
}

CheckResult check_gravity(const Moments& force) {
  const double size = force.mean.norm();
  return judged("imu.gravity", figure(size, "m/s^2", 3),
                fmt::format("{:.2f} +- {:g} m/s^2", kGravity, kGravityTolerance_m_s2), gravity_finding(size));
}

std::string level_finding(const Eigen::Vector3d& direction, double tilt_deg) {
  constexpr const char* kAxes[] = {"x", "y", "z"};
  if (tilt_deg <= kTilt_deg) return "";
  if (tilt_deg >= 180.0 - kTilt_deg)
    return "specific force points to +z: sign of the accelerometer reversed, or axes FLU (z up) instead of "
           "FRD; it is "
           "(0, 0, -g) at rest. --hand tells which";
  Eigen::Index axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  if (std::abs(direction(axis)) > std::cos(kTilt_deg / math::kDegPerRad))
    return fmt::format("axes swapped: gravity is on {}{} instead of -z", direction(axis) > 0.0 ? "+" : "-",
                       kAxes[axis]);
  return fmt::format("the IMU is tilted by {:.0f} degrees against the floor: is the vehicle level?",
                     tilt_deg);
}

CheckResult check_level(const Moments& force) {
  if (force.mean.norm() < 1e-3) return skipped("imu.level", "no gravity is measured");
  const Eigen::Vector3d direction = force.mean.normalized();
  const double tilt_deg = angle_deg(direction, {0.0, 0.0, -1.0});
  return judged("imu.level", figure(tilt_deg, "degrees", 1, " from -z: direction " + to_string(direction, 2)),
                fmt::format("at most {:.0f} degrees", kTilt_deg), level_finding(direction, tilt_deg));
}

// Noise and bias of a gyro in degrees per second are 57 times as large.
CheckResult check_gyro(const Moments& rates, bool still) {
  const double bias = rates.mean.norm();
  const bool noisy = rates.deviation > kGyroNoise_rad_s;
  const bool biased = bias > kGyroBias_rad_s;
  std::string finding;
  if ((noisy || biased) && still) {
    finding = fmt::format(
        "gyro in degrees/s, or not calibrated: at rest its {} is {:.2f} instead of at most {:g} rad/s; "
        "--hand tells which",
        noisy ? "noise" : "bias", noisy ? rates.deviation : bias, noisy ? kGyroNoise_rad_s : kGyroBias_rad_s);
  } else if (noisy || biased) {
    finding = "the gyro shows motion: the vehicle does not stand still";
  }
  return judged("imu.gyro",
                figure(bias, "rad/s", 4, fmt::format(" bias, {:.4f} rad/s noise", rates.deviation)),
                fmt::format("bias {:g}, noise {:g} rad/s", kGyroBias_rad_s, kGyroNoise_rad_s), finding);
}

std::vector<plant::PoseSample> tracked_poses(const VehicleRecording& recording) {
  std::vector<plant::PoseSample> poses;
  for (const auto& received : recording.mocap.samples) {
    if (received.sample.tracked) poses.push_back(received.sample);
  }
  return poses;
}

CheckResult check_tracked(std::size_t tracked, std::size_t frames) {
  const double lost = 1.0 - static_cast<double>(tracked) / static_cast<double>(frames);
  return judged("mocap_pose.tracked", figure(1e2 * lost, "%", 1, " of the frames untracked"),
                fmt::format("at most {:.0f} %", 1e2 * kMostUntracked),
                lost <= kMostUntracked ? "" : "motion capture does not see the vehicle in all frames");
}

CheckResult check_mocap_values(const std::vector<plant::PoseSample>& poses) {
  std::size_t repeated = 0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].position_ned == poses[i - 1].position_ned &&
        poses[i].q_ned_from_frd.coeffs() == poses[i - 1].q_ned_from_frd.coeffs())
      ++repeated;
  }
  const double part = static_cast<double>(repeated) / static_cast<double>(poses.size() - 1);
  return judged(
      "mocap_pose.values", figure(1e2 * part, "%", 1, " repeated bit for bit"),
      fmt::format("at most {:.0f} %", 1e2 * kMostRepeated),
      part <= kMostRepeated ? "" : "poses repeat bit for bit: frames are sent again, or tracking is stuck");
}

CheckResult check_mocap_still(const std::vector<plant::PoseSample>& poses) {
  const Moments position =
      moments(poses.size(), [&](std::size_t i) -> Eigen::Vector3d { return poses[i].position_ned; });
  return judged(
      "mocap_pose.still", figure(1e3 * position.deviation, "mm", 2, " standard deviation"),
      fmt::format("at most {:g} mm", 1e3 * kPositionNoise_m),
      position.deviation <= kPositionNoise_m
          ? ""
          : "the position moves although the vehicle stands: another body, wrong unit, or reflections");
}

// Direction of "up" in body axes: by the accelerometer and by motion capture.
CheckResult check_mocap_gravity(const std::vector<plant::PoseSample>& poses, const Eigen::Vector3d& force) {
  const Moments up = moments(poses.size(), [&](std::size_t i) -> Eigen::Vector3d {
    return poses[i].q_ned_from_frd.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.0);
  });
  const double off_deg = angle_deg(up.mean, force);
  std::string finding;
  if (off_deg > 150.0) {
    finding = "motion capture attitude is upside down against gravity: ENU or FLU in q_ned_from_frd";
  } else if (off_deg > 75.0) {
    finding = "motion capture attitude is turned by about 90 degrees against gravity: axes swapped, y up?";
  } else if (off_deg > kAlignment_deg) {
    finding = fmt::format(
        "motion capture attitude is misaligned by {:.1f} degrees with the vehicle: align the marker body",
        off_deg);
  }
  return judged("mocap_pose.gravity", figure(off_deg, "degrees", 2, " from the accelerometer's vertical"),
                fmt::format("at most {:g} degrees", kAlignment_deg), finding);
}

}  // namespace

Eigen::Vector3d mean_specific_force(const VehicleRecording& recording) {
  return force_moments(recording).mean;
}
Eigen::Vector3d mean_body_rates(const VehicleRecording& recording) { return rate_moments(recording).mean; }

CheckResults check_imu_at_rest(const VehicleRecording& recording) {
  if (recording.imu.samples.size() < kFewest) return {};
  const Moments force = force_moments(recording);
  const bool still = force.deviation <= kQuietForce_m_s2;
  return {check_values(recording), check_still(force), check_gravity(force), check_level(force),
          check_gyro(rate_moments(recording), still)};
}

CheckResults check_mocap_at_rest(const VehicleRecording& recording, const CheckResults& imu) {
  const std::size_t frames = recording.mocap.samples.size();
  if (frames < kFewest) return {};
  const std::vector<plant::PoseSample> poses = tracked_poses(recording);
  CheckResults results = {check_tracked(poses.size(), frames)};
  if (poses.size() < kFewest) return results;
  results.push_back(check_mocap_values(poses));
  results.push_back(check_mocap_still(poses));
  results.push_back(passes(imu, "imu.gravity") && passes(imu, "imu.level")
                        ? check_mocap_gravity(poses, mean_specific_force(recording))
                        : skipped("mocap_pose.gravity", recording.imu.samples.empty()
                                                            ? "the vehicle sends no imu"
                                                            : "the IMU does not show gravity as it should"));
  return results;
}

}  // namespace swiftlet::ground

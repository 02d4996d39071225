#include "swiftlet/ground/vehicle_check/odometry.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <fmt/core.h>

#include "swiftlet/ground/vehicle_check/axes.hpp"
#include "swiftlet/math/angles.hpp"

namespace swiftlet::ground {
namespace {

using Eigen::Vector3d;

constexpr double kSpeed_m_s = 0.1;
constexpr double kRate_rad_s = 0.1;

// "Down" in body axes.
Vector3d down_frd(const Eigen::Quaterniond& q_ned_from_frd) {
  return q_ned_from_frd.conjugate() * Vector3d::UnitZ();
}

CheckResult check_valid(const VehicleRecording& recording) {
  const auto& samples = recording.odometry.samples;
  const auto whole = std::count_if(samples.begin(), samples.end(), [](const auto& received) {
    const plant::OdometrySample& sample = received.sample.odometry;
    return sample.position_valid && sample.velocity_valid;
  });
  const double part = static_cast<double>(whole) / static_cast<double>(samples.size());
  return judged("vehicle_odometry.valid", figure(1e2 * part, "%", 1, " with position and velocity"), "100 %",
                whole == static_cast<std::ptrdiff_t>(samples.size())
                    ? ""
                    : "the vehicle does not know its position or its velocity");
}

CheckResult check_level(const plant::OdometrySample& sample) {
  const double tilt_deg = angle_deg(down_frd(sample.q_ned_from_frd), Vector3d::UnitZ());
  std::string finding;
  if (tilt_deg >= 180.0 - kTilt_deg) {
    finding = "the attitude is upside down: ENU or FLU in q_ned_from_frd";
  } else if (tilt_deg > kTilt_deg) {
    finding = fmt::format(
        "the attitude is tilted by {:.0f} degrees: is the vehicle level? Components in another order than w, "
        "x, y, z?",
        tilt_deg);
  }
  return judged("vehicle_odometry.level", figure(tilt_deg, "degrees", 1, " from level"),
                fmt::format("at most {:.0f} degrees", kTilt_deg), finding);
}

CheckResult check_greatest(const VehicleRecording& recording, const char* name, const char* unit,
                           double limit, Vector3d plant::OdometrySample::*quantity, const char* finding) {
  double greatest = 0.0;
  for (const auto& received : recording.odometry.samples)
    greatest = std::max(greatest, (received.sample.odometry.*quantity).norm());
  return judged(name, figure(greatest, unit, 3, " at most"), fmt::format("at most {:g} {}", limit, unit),
                greatest <= limit ? "" : finding);
}

CheckResult check_resets(const VehicleRecording& recording) {
  const auto& samples = recording.odometry.samples;
  const std::uint32_t resets = samples.back().sample.odometry.resets - samples.front().sample.odometry.resets;
  return judged("vehicle_odometry.resets", figure(resets, "jumps", 0), "none",
                resets == 0 ? "" : "the vehicle's estimate jumps while it stands");
}

CheckResult check_against_mocap(const VehicleRecording& recording, const plant::OdometrySample& sample) {
  const std::optional<plant::PoseSample> pose = last_pose(recording);
  if (!pose) return skipped("vehicle_odometry.mocap", "no pose of motion capture");
  const double off_deg = angle_deg(down_frd(sample.q_ned_from_frd), down_frd(pose->q_ned_from_frd));
  const double distance_m = (sample.position_ned - pose->position_ned).norm();
  const double turn_deg = math::kDegPerRad * sample.q_ned_from_frd.angularDistance(pose->q_ned_from_frd);
  return judged(
      "vehicle_odometry.mocap",
      figure(off_deg, "degrees", 2,
             fmt::format(" between the verticals; {:.2f} m and {:.1f} degrees in all", distance_m, turn_deg)),
      fmt::format("at most {:g} degrees between the verticals", kAlignment_deg),
      off_deg <= kAlignment_deg
          ? ""
          : "the attitudes of the vehicle and of motion capture differ in tilt: align the marker body, or "
            "look at axes and signs");
}

}  // namespace

bool brings_odometry(const VehicleRecording& recording) {
  const bool sends_imu = recording.imu.published || !recording.imu.samples.empty();
  return !sends_imu && (recording.odometry.published || !recording.odometry.samples.empty());
}

CheckResults check_odometry_at_rest(const VehicleRecording& recording) {
  if (recording.odometry.samples.size() < kFewest) return {};
  const plant::OdometrySample& last = recording.odometry.samples.back().sample.odometry;
  return {check_valid(recording),
          check_level(last),
          check_greatest(recording, "vehicle_odometry.speed", "m/s", kSpeed_m_s,
                         &plant::OdometrySample::velocity_ned,
                         "the estimate moves although the vehicle stands, or the velocity has another unit"),
          check_greatest(recording, "vehicle_odometry.rates", "rad/s", kRate_rad_s,
                         &plant::OdometrySample::body_rates_frd,
                         "the body rates are in degrees/s, or not without the bias of the gyro"),
          check_resets(recording),
          check_against_mocap(recording, last)};
}

}  // namespace swiftlet::ground

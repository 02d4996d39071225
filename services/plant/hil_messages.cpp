#include "swiftlet/services/plant/hil_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "swiftlet/math/geodesy.hpp"

namespace swiftlet::services {
namespace {

using Eigen::Vector3d;

constexpr double kDegE7 = 1e7;
constexpr double kCm = 100.0;
constexpr double kMm = 1000.0;
constexpr double kMilliG = 1000.0 / plant::kGravity;
constexpr double kHpaPerPa = 0.01;
constexpr int kSatellites = 12;

// The nearest integer of this type; 0 for NaN.
template <class Integer>
Integer rounded(double value) {
  using Limits = std::numeric_limits<Integer>;
  if (std::isnan(value)) return 0;
  return static_cast<Integer>(
      std::clamp<double>(std::round(value), double{Limits::min()}, double{Limits::max()}));
}

std::array<float, 3> to_floats(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

std::array<std::int16_t, 3> to_shorts(const Vector3d& v) {
  return {rounded<std::int16_t>(v.x()), rounded<std::int16_t>(v.y()), rounded<std::int16_t>(v.z())};
}

// 0 .. 35999, or unknown at rest.
std::uint16_t course_cdeg(const Vector3d& velocity_ned) {
  if (velocity_ned.head<2>().norm() < 1e-3) return mavlink::HilGps::kUnknown;
  const double course_deg = std::atan2(velocity_ned.y(), velocity_ned.x()) * 180.0 / M_PI;
  return static_cast<std::uint16_t>(
      rounded<int>((course_deg < 0.0 ? course_deg + 360.0 : course_deg) * 100.0) % 36'000);
}

}  // namespace

mavlink::HilSensor hil_sensor(std::uint64_t time_usec, const std::optional<plant::ImuSample>& imu,
                              const plant::NavigationSamples& navigation) {
  using mavlink::HilSensor;
  HilSensor message;
  message.time_usec = time_usec;
  if (imu) {
    message.acceleration = to_floats(imu->specific_force_frd);
    message.gyro = to_floats(imu->body_rates_frd);
    message.fields_updated |= HilSensor::kAccelerometer | HilSensor::kGyro;
  }
  if (navigation.magnetic_field_frd) {
    message.mag = to_floats(*navigation.magnetic_field_frd);
    message.fields_updated |= HilSensor::kMagnetometer;
  }
  if (navigation.barometer) {
    message.abs_pressure = static_cast<float>(navigation.barometer->pressure_pa * kHpaPerPa);
    message.pressure_alt = static_cast<float>(navigation.barometer->altitude_m);
    message.temperature = static_cast<float>(navigation.barometer->temperature_c);
    message.fields_updated |= HilSensor::kBarometer;
  }
  return message;
}

mavlink::HilGps hil_gps(std::uint64_t unix_usec, const plant::GpsSample& gps) {
  mavlink::HilGps message;
  message.time_usec = unix_usec;
  message.fix_type = mavlink::HilGps::kFix3d;
  message.lat = rounded<std::int32_t>(gps.position.latitude_deg * kDegE7);
  message.lon = rounded<std::int32_t>(gps.position.longitude_deg * kDegE7);
  message.alt = rounded<std::int32_t>(gps.altitude_m * kMm);
  message.eph = rounded<std::uint16_t>(gps.horizontal_accuracy_m * kCm);
  message.epv = rounded<std::uint16_t>(gps.vertical_accuracy_m * kCm);
  message.vel = rounded<std::uint16_t>(gps.velocity_ned.head<2>().norm() * kCm);
  const auto [north, east, down] = to_shorts(gps.velocity_ned * kCm);
  message.vn = north;
  message.ve = east;
  message.vd = down;
  message.cog = course_cdeg(gps.velocity_ned);
  message.satellites_visible = kSatellites;
  return message;
}

mavlink::HilStateQuaternion hil_state(std::uint64_t time_usec, const plant::TruthSample& truth,
                                      const std::optional<plant::ImuSample>& imu,
                                      const plant::SiteSettings& site) {
  mavlink::HilStateQuaternion message;
  message.time_usec = time_usec;
  const Eigen::Quaterniond& q = truth.q_ned_from_frd;
  message.attitude_quaternion = {static_cast<float>(q.w()), static_cast<float>(q.x()),
                                 static_cast<float>(q.y()), static_cast<float>(q.z())};
  message.body_rates = to_floats(truth.body_rates_frd);
  const math::GeographicPosition position = math::position_at({site.latitude_deg, site.longitude_deg},
                                                              Eigen::Vector2d(truth.position_ned.head<2>()));
  message.lat = rounded<std::int32_t>(position.latitude_deg * kDegE7);
  message.lon = rounded<std::int32_t>(position.longitude_deg * kDegE7);
  message.alt = rounded<std::int32_t>((site.altitude_m - truth.position_ned.z()) * kMm);
  message.velocity = to_shorts(truth.velocity_ned * kCm);
  if (imu) {
    const Vector3d acceleration_ned = q * imu->specific_force_frd + Vector3d(0.0, 0.0, plant::kGravity);
    message.acceleration = to_shorts(acceleration_ned * kMilliG);
  }
  return message;
}

}  // namespace swiftlet::services

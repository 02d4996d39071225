// The gains that the control laws fly with, and their change in flight from one set to another.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include <Eigen/Core>

namespace swiftlet::control {

// Vectors have one entry per axis: roll, pitch, yaw of the attitude; x, y, z of the position.
struct ControlGains {
  // u = -(angle, rate, moment / inertia) k, u the commanded moment / inertia, rad/s^2.
  Eigen::Vector3d attitude_angle = Eigen::Vector3d::Zero();         // 1/s^2
  Eigen::Vector3d attitude_rate = Eigen::Vector3d::Zero();          // 1/s
  Eigen::Vector3d attitude_acceleration = Eigen::Vector3d::Zero();  // 1; 0 on Eq. (38)-(40)
  // a = a_r + k_v (u_r - u) + k_p (x_r - x) + k_i integral(x_r - x), Eq. (48) and its integral form.
  Eigen::Vector3d position_p = Eigen::Vector3d::Zero();  // 1/s^2
  Eigen::Vector3d position_v = Eigen::Vector3d::Zero();  // 1/s
  Eigen::Vector3d position_i = Eigen::Vector3d::Zero();  // 1/s^3
  double integral_limit = 0.0;                           // m/s^2
  double disturbance_bandwidth = 0.0;                    // rad/s
  double disturbance_limit = 0.0;                        // m/s^2
};
bool operator==(const ControlGains& a, const ControlGains& b);
inline bool operator!=(const ControlGains& a, const ControlGains& b) { return !(a == b); }

// from + fraction (to - from), for each gain.
ControlGains blend(const ControlGains& from, const ControlGains& to, double fraction);

// The name of control settings, terminated by 0; longer names are cut.
constexpr std::size_t kMaxSettingsName = 31;
using SettingsName = std::array<char, kMaxSettingsName + 1>;
SettingsName settings_name(const std::string& name);

// The gains over time. They do not step: from start_ns on they go from `from` to `to` within duration_s,
// along a cubic whose rate is zero at both ends. Outside this time they are constant.
struct GainChange {
  ControlGains from;
  ControlGains to;
  SettingsName name{};        // of the control settings of `to`
  std::int64_t start_ns = 0;  // vehicle's clock
  double duration_s = 0.0;    // 0: `to` holds

  double progress(std::int64_t now_ns) const;  // 0 .. 1, of the time
  ControlGains at(std::int64_t now_ns) const;
  double remaining_s(std::int64_t now_ns) const { return (1.0 - progress(now_ns)) * duration_s; }
};

}  // namespace swiftlet::control

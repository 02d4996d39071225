#include "swiftlet/control/types/gains.hpp"

#include <algorithm>

namespace swiftlet::control {

bool operator==(const ControlGains& a, const ControlGains& b) {
  return a.attitude_angle == b.attitude_angle && a.attitude_rate == b.attitude_rate &&
         a.attitude_acceleration == b.attitude_acceleration && a.position_p == b.position_p &&
         a.position_v == b.position_v && a.position_i == b.position_i &&
         a.integral_limit == b.integral_limit && a.disturbance_bandwidth == b.disturbance_bandwidth &&
         a.disturbance_limit == b.disturbance_limit;
}

ControlGains blend(const ControlGains& from, const ControlGains& to, double fraction) {
  const auto between = [fraction](const auto& a, const auto& b) { return a + fraction * (b - a); };
  ControlGains out;
  out.attitude_angle = between(from.attitude_angle, to.attitude_angle);
  out.attitude_rate = between(from.attitude_rate, to.attitude_rate);
  out.attitude_acceleration = between(from.attitude_acceleration, to.attitude_acceleration);
  out.position_p = between(from.position_p, to.position_p);
  out.position_v = between(from.position_v, to.position_v);
  out.position_i = between(from.position_i, to.position_i);
  out.integral_limit = between(from.integral_limit, to.integral_limit);
  out.disturbance_bandwidth = between(from.disturbance_bandwidth, to.disturbance_bandwidth);
  out.disturbance_limit = between(from.disturbance_limit, to.disturbance_limit);
  return out;
}

SettingsName settings_name(const std::string& name) {
  SettingsName out{};
  std::copy_n(name.begin(), std::min(name.size(), kMaxSettingsName), out.begin());
  return out;
}

double GainChange::progress(std::int64_t now_ns) const {
  if (!(duration_s > 0.0)) return 1.0;
  return std::clamp(1e-9 * static_cast<double>(now_ns - start_ns) / duration_s, 0.0, 1.0);
}

ControlGains GainChange::at(std::int64_t now_ns) const {
  const double s = progress(now_ns);
  return s < 1.0 ? blend(from, to, s * s * (3.0 - 2.0 * s)) : to;
}

}  // namespace swiftlet::control

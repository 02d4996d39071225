#include "swiftlet/services/messages/convert_gains.hpp"

#include <string>

namespace swiftlet::messages {

using namespace wire;

void check_gains(const char* name, const msg::ControlGains& gains, Check& check) {
  check.finite(name, gains.attitude_angle())
      .finite(name, gains.attitude_rate())
      .finite(name, gains.attitude_acceleration())
      .finite(name, gains.position_p())
      .finite(name, gains.position_v())
      .finite(name, gains.position_i())
      .at_least(name, gains.integral_limit(), 0.0)
      .at_least(name, gains.disturbance_bandwidth(), 0.0)
      .at_least(name, gains.disturbance_limit(), 0.0);
}

control::ControlGains from_message(const msg::ControlGains& in) {
  control::ControlGains out;
  out.attitude_angle = vector(in.attitude_angle());
  out.attitude_rate = vector(in.attitude_rate());
  out.attitude_acceleration = vector(in.attitude_acceleration());
  out.position_p = vector(in.position_p());
  out.position_v = vector(in.position_v());
  out.position_i = vector(in.position_i());
  out.integral_limit = in.integral_limit();
  out.disturbance_bandwidth = in.disturbance_bandwidth();
  out.disturbance_limit = in.disturbance_limit();
  return out;
}

msg::ControlGains to_message(const control::ControlGains& in) {
  msg::ControlGains out;
  out.attitude_angle(array(in.attitude_angle));
  out.attitude_rate(array(in.attitude_rate));
  out.attitude_acceleration(array(in.attitude_acceleration));
  out.position_p(array(in.position_p));
  out.position_v(array(in.position_v));
  out.position_i(array(in.position_i));
  out.integral_limit(in.integral_limit);
  out.disturbance_bandwidth(in.disturbance_bandwidth);
  out.disturbance_limit(in.disturbance_limit);
  return out;
}

// The rules of the values themselves are those of the control settings file: validate() of control checks
// them.
Fault from_message(const msg::ControlSettings& in, control::SettingsRequest& out) {
  Check check;
  check.within("ramp_s", in.ramp_s(), control::kShortestGainChange_s, control::kLongestGainChange_s)
      .finite("roll_q", in.roll_q())
      .finite("roll_r", in.roll_r())
      .finite("pitch_q", in.pitch_q())
      .finite("pitch_r", in.pitch_r())
      .finite("yaw_q", in.yaw_q())
      .finite("yaw_r", in.yaw_r())
      .finite("omega_n", in.omega_n())
      .finite("zeta", in.zeta())
      .finite("epsilon", in.epsilon())
      .finite("integral_pole", in.integral_pole())
      .finite("integral_limit", in.integral_limit())
      .finite("disturbance_bandwidth", in.disturbance_bandwidth())
      .finite("disturbance_limit", in.disturbance_limit())
      .at_most("number of fixed settings", in.fixed_settings().size(), control::kMaxFixedSettings);
  if (!check.ok()) return check.fault();
  const auto axis = [&in](std::size_t i) {
    return control::RptSettings{in.omega_n()[i], in.zeta()[i], in.epsilon()[i], in.integral_pole()[i]};
  };
  out = {};
  out.name = in.name().c_str();
  out.ramp_s = in.ramp_s();
  out.tunable.roll = {vector(in.roll_q()), in.roll_r()};
  out.tunable.pitch = {vector(in.pitch_q()), in.pitch_r()};
  out.tunable.yaw = {vector(in.yaw_q()), in.yaw_r()};
  out.tunable.position = {axis(0), axis(1), axis(2), in.integral_limit()};
  out.tunable.disturbance = {in.disturbance_bandwidth(), in.disturbance_limit()};
  for (const msg::FixedSetting& setting : in.fixed_settings())
    out.fixed.push_back({setting.key().c_str(), setting.value().c_str()});
  return {};
}

msg::ControlSettings to_message(const control::SettingsRequest& in) {
  const control::PositionSettings& position = in.tunable.position;
  const auto axes = [&position](double control::RptSettings::*value) {
    return Vector3{position.x.*value, position.y.*value, position.z.*value};
  };
  msg::ControlSettings out;
  out.name() = in.name.c_str();
  out.ramp_s(in.ramp_s);
  out.roll_q(array(in.tunable.roll.q));
  out.roll_r(in.tunable.roll.r);
  out.pitch_q(array(in.tunable.pitch.q));
  out.pitch_r(in.tunable.pitch.r);
  out.yaw_q(array(in.tunable.yaw.q));
  out.yaw_r(in.tunable.yaw.r);
  out.omega_n(axes(&control::RptSettings::omega_n));
  out.zeta(axes(&control::RptSettings::zeta));
  out.epsilon(axes(&control::RptSettings::epsilon));
  out.integral_pole(axes(&control::RptSettings::integral_pole));
  out.integral_limit(position.integral_limit);
  out.disturbance_bandwidth(in.tunable.disturbance.bandwidth);
  out.disturbance_limit(in.tunable.disturbance.limit);
  for (const control::FixedSetting& setting : in.fixed) {
    msg::FixedSetting message;
    message.key() = setting.key.c_str();
    message.value() = setting.value.c_str();
    out.fixed_settings().push_back(message);
  }
  return out;
}

}  // namespace swiftlet::messages

#include "swiftlet/ground/client/vehicle_setpoints.hpp"

namespace swiftlet::ground {
namespace {

using control::Setpoint;
using control::SetpointKind;

Setpoint with_heading(SetpointKind kind, const HeadingSetpoint& heading) {
  Setpoint out;
  out.kind = kind;
  out.yaw_free = !heading.yaw_rad;
  out.yaw_rad = heading.yaw_rad.value_or(0.0);
  out.yaw_rate = heading.yaw_rate_rad_s;
  return out;
}

}  // namespace

Setpoint to_setpoint(const PositionSetpoint& in) {
  Setpoint out = with_heading(SetpointKind::kPosition, in.heading);
  out.position_ned = in.position_ned_m;
  out.velocity_ned = in.velocity_ned_m_s;
  out.acceleration_ned = in.acceleration_ned_m_s2;
  return out;
}

Setpoint to_setpoint(const VelocitySetpoint& in) {
  Setpoint out = with_heading(SetpointKind::kVelocity, in.heading);
  out.velocity_ned = in.velocity_ned_m_s;
  out.acceleration_ned = in.acceleration_ned_m_s2;
  return out;
}

Setpoint to_setpoint(const AccelerationSetpoint& in) {
  Setpoint out = with_heading(SetpointKind::kAcceleration, in.heading);
  out.acceleration_ned = in.acceleration_ned_m_s2;
  return out;
}

Setpoint to_setpoint(const AttitudeSetpoint& in) {
  Setpoint out;
  out.kind = SetpointKind::kAttitude;
  out.q_ned_from_frd = in.q_ned_from_frd;
  out.body_rates_frd = in.body_rates_frd_rad_s;
  out.specific_thrust = in.specific_thrust_m_s2;
  return out;
}

Setpoint to_setpoint(const BodyRatesSetpoint& in) {
  Setpoint out;
  out.kind = SetpointKind::kBodyRates;
  out.body_rates_frd = in.body_rates_frd_rad_s;
  out.specific_thrust = in.specific_thrust_m_s2;
  return out;
}

}  // namespace swiftlet::ground

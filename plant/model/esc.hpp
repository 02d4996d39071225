// ESC, Eq. (8) and (9): pulse width -> throttle delta -> mean motor voltage v_a, and back. Identified for v_s
// of 3.6 to 4.2 V. Total: finite arguments, up to 1e100, give finite results; throttles are clipped to
// 0 .. 1, roots of negative numbers are 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Eq. (8), 0 .. 1. Pulse width in us.
inline double throttle_from_pulse_width(const Esc& esc, double pulse_width_us) {
  return std::clamp((pulse_width_us - esc.pulse_min_us) / esc.pulse_range_us, 0.0, 1.0);
}

// Eq. (8) backwards: us.
inline double pulse_width_from_throttle(const Esc& esc, double throttle) {
  return esc.pulse_min_us + esc.pulse_range_us * std::clamp(throttle, 0.0, 1.0);
}

// Eq. (9): v_a in V at supply voltage v_s in V. At throttle 0 it is sqrt(offset), not 0: rotors that are off
// get no ESC output at all.
inline double motor_voltage(const Esc& esc, double supply_voltage_v, double throttle) {
  const double square =
      esc.gain * supply_voltage_v * supply_voltage_v * std::clamp(throttle, 0.0, 1.0) + esc.offset_v2;
  return std::sqrt(std::max(square, 0.0));
}

// Eq. (9) backwards: the throttle, 0 .. 1, that comes nearest to v_a. Below the intercept sqrt(offset) that
// is 0; above what the supply can give, 1.
inline double throttle_from_motor_voltage(const Esc& esc, double supply_voltage_v, double motor_voltage_v) {
  const double wanted = std::max(motor_voltage_v, 0.0) * std::max(motor_voltage_v, 0.0) - esc.offset_v2;
  const double available = esc.gain * supply_voltage_v * supply_voltage_v;
  if (wanted <= 0.0) return 0.0;
  return wanted < available ? wanted / available : 1.0;
}

// Current drawn from the supply, A, for current i_a in the motor. Not in the paper: an ESC without loss, v_s
// i_s = v_a i_a, that lets nothing flow back.
inline double esc_supply_current(double supply_voltage_v, double motor_voltage_v, double motor_current_a) {
  return supply_voltage_v > 0.0 ? std::max(motor_voltage_v * motor_current_a / supply_voltage_v, 0.0) : 0.0;
}

}  // namespace swiftlet::plant

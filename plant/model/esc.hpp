// ESC, Eq. (8) and (9): pulse width -> throttle delta -> mean motor voltage v_a, and the inverse. Identified
// for v_s from 3.6 to 4.2 V. Finite arguments up to 1e100 give finite results: throttles are clamped to
// 0 .. 1, and the root of a negative number is taken as 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Throttle of Eq. (8), 0 .. 1, from a pulse width in us.
inline double throttle_from_pulse_width(const Esc& esc, double pulse_width_us) {
  return std::clamp((pulse_width_us - esc.pulse_min_us) / esc.pulse_range_us, 0.0, 1.0);
}

// Inverse of Eq. (8): pulse width in us.
inline double pulse_width_from_throttle(const Esc& esc, double throttle) {
  return esc.pulse_min_us + esc.pulse_range_us * std::clamp(throttle, 0.0, 1.0);
}

// Eq. (9): v_a in V at supply voltage v_s in V. At throttle 0 it is sqrt(offset), not 0. This applies to
// running rotors only: for rotors that are off, the ESC has no output.
inline double motor_voltage(const Esc& esc, double supply_voltage_v, double throttle) {
  const double square =
      esc.gain * supply_voltage_v * supply_voltage_v * std::clamp(throttle, 0.0, 1.0) + esc.offset_v2;
  return std::sqrt(std::max(square, 0.0));
}

// Inverse of Eq. (9): the throttle, 0 .. 1, whose motor voltage is nearest to v_a. It is 0 below the
// intercept sqrt(offset) and 1 above the largest voltage that the supply allows.
inline double throttle_from_motor_voltage(const Esc& esc, double supply_voltage_v, double motor_voltage_v) {
  const double wanted = std::max(motor_voltage_v, 0.0) * std::max(motor_voltage_v, 0.0) - esc.offset_v2;
  const double available = esc.gain * supply_voltage_v * supply_voltage_v;
  if (wanted <= 0.0) return 0.0;
  return wanted < available ? wanted / available : 1.0;
}

// Current drawn from the supply, A, for the motor current i_a. Not in the paper: assumes an ESC without loss,
// v_s i_s = v_a i_a, and no regeneration, i_s >= 0.
inline double esc_supply_current(double supply_voltage_v, double motor_voltage_v, double motor_current_a) {
  return supply_voltage_v > 0.0 ? std::max(motor_voltage_v * motor_current_a / supply_voltage_v, 0.0) : 0.0;
}

}  // namespace swiftlet::plant

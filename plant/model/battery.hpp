// Battery: open-circuit voltage over state of charge, and a first-order lag for the sag under load. Not in
// the paper.
#pragma once

#include <algorithm>
#include <cstddef>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// V, linear between the points of the table. The state of charge is clamped to 0 .. 1.
inline double open_circuit_voltage(const BatteryParameters& battery, double state_of_charge) {
  const std::vector<double>& soc = battery.state_of_charge;
  const std::vector<double>& voltage = battery.open_circuit_voltage_v;
  const double s = std::clamp(state_of_charge, 0.0, 1.0);
  std::size_t i = 1;
  while (i + 1 < soc.size() && soc[i] < s) ++i;
  return voltage[i - 1] + (voltage[i] - voltage[i - 1]) * (s - soc[i - 1]) / (soc[i] - soc[i - 1]);
}

// State of charge, 0 .. 1: the inverse of open_circuit_voltage(). The voltage is clamped to the range of the
// table.
inline double state_of_charge_from_voltage(const BatteryParameters& battery, double open_circuit_voltage_v) {
  const std::vector<double>& soc = battery.state_of_charge;
  const std::vector<double>& voltage = battery.open_circuit_voltage_v;
  const double v = std::clamp(open_circuit_voltage_v, voltage.front(), voltage.back());
  std::size_t i = 1;
  while (i + 1 < voltage.size() && voltage[i] < v) ++i;
  return soc[i - 1] + (soc[i] - soc[i - 1]) * (v - voltage[i - 1]) / (voltage[i] - voltage[i - 1]);
}

// v_s of Eq. (9), V: v_oc(soc) - v_sag, at least 0.
inline double terminal_voltage(const BatteryParameters& battery, double state_of_charge,
                               double sag_voltage_v) {
  return std::max(open_circuit_voltage(battery, state_of_charge) - sag_voltage_v, 0.0);
}

// d soc/dt, 1/s.
inline double state_of_charge_rate(const BatteryParameters& battery, double current_a) {
  return -current_a / (3600.0 * battery.capacity_ah);
}

// dv_sag/dt, V/s: tau dv_sag/dt = R i - v_sag.
inline double sag_rate(const BatteryParameters& battery, double current_a, double sag_voltage_v) {
  return (battery.internal_resistance_ohm * current_a - sag_voltage_v) / battery.sag_time_constant_s;
}

}  // namespace swiftlet::plant

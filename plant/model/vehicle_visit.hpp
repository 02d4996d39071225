// Visits of the parameters of a vehicle (setting.hpp): keys of the vehicle file, units, limits, meanings.
// By hand: `name`, the coefficients of blades in place of `rotor`, and the rules between several parameters in validate().
#pragma once

#include <cstddef>

#include "swiftlet/plant/model/setting.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

constexpr double kMinTimeConstant = 1e-3;  // s; shorter ones cannot be integrated in real time
constexpr std::size_t kMaxBatteryPoints = 1000;

template <class Visitor>
void visit(RotorMount& s, Visitor& v) {
  v({"position_frd", "m", {}, "hub relative to the centre of mass"}, s.position_frd);
  v({"spin", "seen from above"}, s.spin, {"counter_clockwise", "clockwise"});
}

template <class Visitor>
void visit(RotorCoefficients& s, Visitor& v) {
  v({{"thrust", "thrust_factor"}, "N*s^2", above(0.0), "k_T"}, s.thrust);
  v({{"torque", "torque_factor"}, "N*m*s^2", above(0.0), "k_Q"}, s.torque);
}

template <class Visitor>
void visit(Motor& s, Visitor& v) {
  v({"model", "first order in speed, Eq. (18), or Eq. (10) and (15)"}, s.model, {"reduced", "physical"});
  v({{"time_constant_s", "time_constant"}, "s", at_least(kMinTimeConstant), "tau_m of Eq. (18)"},
    s.time_constant_s);
  v({"k2", "V*s/rad", above(0.0), "K2 of Eq. (22)"}, s.k2);
  v({"k3", "V*s^2/rad^2", above(0.0), "K3 of Eq. (22)"}, s.k3);
  v({{"armature_resistance_ohm", "armature_resistance"}, "ohm", above(0.0), "R_a"},
    s.armature_resistance_ohm);
  v({{"armature_inductance_h", "armature_inductance"}, "H", at_least(0.0), "L_a, 0: none"},
    s.armature_inductance_h);
}

template <class Visitor>
void visit(Esc& s, Visitor& v) {
  v({"gain", "1", above(0.0)}, s.gain);
  v({{"offset_v2", "offset"}, "V^2", finite()}, s.offset_v2);
  v(Setting{{"pulse_min_us", "pulse_min"}, "us", at_least(0.0), "pulse width at delta = 0"}.fixed(),
    s.pulse_min_us);
  v(Setting{{"pulse_range_us", "pulse_range"}, "us", above(0.0), "from delta = 0 to 1"}.fixed(),
    s.pulse_range_us);
}

template <class Visitor>
void visit(BatteryParameters& s, Visitor& v) {
  v({{"capacity_ah", "capacity"}, "A*h", above(0.0)}, s.capacity_ah);
  v({{"internal_resistance_ohm", "internal_resistance"}, "ohm", at_least(0.0)}, s.internal_resistance_ohm);
  v({{"sag_time_constant_s", "sag_time_constant"}, "s", at_least(kMinTimeConstant)}, s.sag_time_constant_s);
  v({{"electronics_current_a", "electronics_current"}, "A", at_least(0.0), "of everything except the motors"},
    s.electronics_current_a);
  v({{"state_of_charge", "open_circuit.state_of_charge"},
     "1",
     {},
     "0 .. 1, ascending. A copy: assign a whole list"},
    s.state_of_charge, std::size_t{2}, kMaxBatteryPoints);
  v({{"open_circuit_voltage_v", "open_circuit.voltage"},
     "V",
     {},
     "at these states of charge. A copy: assign a whole list"},
    s.open_circuit_voltage_v, std::size_t{2}, kMaxBatteryPoints);
}

template <class Visitor>
void visit(Vehicle& s, Visitor& v) {
  v({{"mass_kg", "mass"}, "kg", above(0.0)}, s.mass_kg);
  v({"inertia", "kg*m^2", {}, "in FRD about the centre of mass; assign a whole array"}, s.inertia);
  v({"linear_drag", "N*s/m", at_least(0.0), "times the velocity relative to the air"}, s.linear_drag);
  v({"rotors"}, s.rotors, std::size_t{kMinRotors}, std::size_t{kMaxRotors});
  v({"rotor", "Eq. (25) and (26)"}, s.rotor);
  v({"motor", "Eq. (10)-(22)"}, s.motor);
  v({"esc", "Eq. (8) and (9): v_a^2 = gain v_s^2 delta + offset"}, s.esc);
  v({"battery", "open-circuit voltage over charge, and the sag under load"}, s.battery);
}

}  // namespace swiftlet::plant

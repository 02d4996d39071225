// Steady-state propulsion chain of one rotor at a supply voltage v_s: throttle delta -> v_a -> Omega ->
// thrust, and the inverse.
#pragma once

#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/rotor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Speed in rad/s, Eq. (9) and (22).
inline double steady_speed_from_throttle(const Vehicle& vehicle, double supply_voltage_v, double throttle) {
  return steady_speed_from_voltage(vehicle.motor, motor_voltage(vehicle.esc, supply_voltage_v, throttle));
}

// Throttle, 0 .. 1, whose steady speed is nearest to the given one.
inline double throttle_from_steady_speed(const Vehicle& vehicle, double supply_voltage_v, double speed) {
  return throttle_from_motor_voltage(vehicle.esc, supply_voltage_v,
                                     voltage_from_steady_speed(vehicle.motor, speed));
}

// Thrust in N, Eq. (9), (22) and (25).
inline double steady_thrust_from_throttle(const Vehicle& vehicle, double supply_voltage_v, double throttle) {
  return thrust_from_speed(vehicle.rotor, steady_speed_from_throttle(vehicle, supply_voltage_v, throttle));
}

// Throttle, 0 .. 1, whose steady thrust is nearest to the given one.
inline double throttle_from_steady_thrust(const Vehicle& vehicle, double supply_voltage_v, double thrust_n) {
  return throttle_from_steady_speed(vehicle, supply_voltage_v, speed_from_thrust(vehicle.rotor, thrust_n));
}

// Steady thrust range of one running rotor at a supply voltage, N: the thrust at throttle 0, which is above
// 0, and at throttle 1.
struct ThrustRange {
  double min = 0.0;
  double max = 0.0;
};
inline ThrustRange steady_thrust_range(const Vehicle& vehicle, double supply_voltage_v) {
  return {steady_thrust_from_throttle(vehicle, supply_voltage_v, 0.0),
          steady_thrust_from_throttle(vehicle, supply_voltage_v, 1.0)};
}

}  // namespace swiftlet::plant

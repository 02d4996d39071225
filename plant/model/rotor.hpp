// Rotor, Eq. (23)-(26): speed Omega in rad/s -> thrust T in N and torque Q in N m, and the inverse. A rotor
// turns in one direction only: a negative thrust gives speed 0.
#pragma once

#include <algorithm>
#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant {

// Eq. (25).
inline double thrust_from_speed(const RotorCoefficients& rotor, double speed) {
  return rotor.thrust * speed * speed;
}

// Eq. (26), the magnitude of the torque. Spin gives its direction.
inline double torque_from_speed(const RotorCoefficients& rotor, double speed) {
  return rotor.torque * speed * speed;
}

// Inverse of Eq. (25).
inline double speed_from_thrust(const RotorCoefficients& rotor, double thrust_n) {
  return std::sqrt(std::max(thrust_n, 0.0) / rotor.thrust);
}

// Factor of the thrust in ground effect, 1 / (1 - (r / 4z)^2) at height z above the ground (Cheeseman and Bennett 1955),
// at most what it is at z = r / 2, the least height of their measurements. radius_m: above 0, of the rotor.
inline double ground_effect(double radius_m, double height_m) {
  const double ratio = radius_m / (4.0 * std::max(height_m, 0.5 * radius_m));
  return 1.0 / (1.0 - ratio * ratio);
}

// Torque over thrust, m.
inline double torque_per_thrust(const RotorCoefficients& rotor) { return rotor.torque / rotor.thrust; }

// Eq. (23) and (24): T = C_T rho A (r Omega)^2, Q = C_Q rho A r^3 Omega^2, A = pi r^2.
struct BladeCoefficients {
  double thrust = 0.0;       // C_T, 1
  double torque = 0.0;       // C_Q, 1
  double radius_m = 0.0;     // r
  double air_density = 0.0;  // rho, kg/m^3
};

RotorCoefficients rotor_coefficients(const BladeCoefficients& blade);
BladeCoefficients blade_coefficients(const RotorCoefficients& rotor, double radius_m, double air_density);

}  // namespace swiftlet::plant

#include "swiftlet/plant/model/rotor.hpp"

#include <cmath>

namespace swiftlet::plant {

namespace {

// rho A r^2 of Eq. (23), kg m.
double thrust_scale(double radius_m, double air_density) {
  return air_density * M_PI * radius_m * radius_m * radius_m * radius_m;
}

}  // namespace

RotorCoefficients rotor_coefficients(const BladeCoefficients& blade) {
  const double scale = thrust_scale(blade.radius_m, blade.air_density);
  return {blade.thrust * scale, blade.torque * scale * blade.radius_m};
}

BladeCoefficients blade_coefficients(const RotorCoefficients& rotor, double radius_m, double air_density) {
  const double scale = thrust_scale(radius_m, air_density);
  return {rotor.thrust / scale, rotor.torque / (scale * radius_m), radius_m, air_density};
}

}  // namespace swiftlet::plant

// The standard atmosphere (ISO 2533) below 11 km: temperature falls linearly with height.
#pragma once

#include <cmath>

#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::plant::atmosphere {

constexpr double kSeaLevelPressure_pa = 101325.0;
constexpr double kSeaLevelTemperature_k = 288.15;
constexpr double kLapse_k_per_m = 0.0065;
constexpr double kGasConstant = 287.05287;  // J/(kg K), of dry air
constexpr double kCelsius_k = 273.15;       // K at 0 deg C

// Altitudes are above mean sea level, m.
inline double temperature_k(double altitude_m) {
  return kSeaLevelTemperature_k - kLapse_k_per_m * altitude_m;
}
inline double pressure_pa(double altitude_m) {
  return kSeaLevelPressure_pa * std::pow(temperature_k(altitude_m) / kSeaLevelTemperature_k,
                                         kGravity / (kGasConstant * kLapse_k_per_m));
}
inline double altitude_m(double pressure_pa) {
  const double ratio = std::pow(pressure_pa / kSeaLevelPressure_pa, kGasConstant * kLapse_k_per_m / kGravity);
  return kSeaLevelTemperature_k * (1.0 - ratio) / kLapse_k_per_m;
}

}  // namespace swiftlet::plant::atmosphere

#include "swiftlet/identification/bench/propeller.hpp"

#include <cmath>

#include "swiftlet/identification/fitting/limits.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::identification {

namespace {

constexpr double kLeastThrustCoefficient = 1e-3;  // a tenth of a small propeller's
constexpr double kMostThrustCoefficient = 0.1;    // blades stall above it

ParameterEstimate scaled(const ParameterEstimate& factor, double coefficient_of_one, const char* parameter,
                         const char* symbol) {
  return {parameter,
          symbol,
          "1",
          factor.value * coefficient_of_one,
          factor.standard_error * coefficient_of_one,
          factor.half_width * coefficient_of_one};
}

void check_tips(const Propeller& propeller, double top_speed) {
  const double tip = top_speed * propeller.radius_m;
  if (tip < kSpeedOfSound) return;
  throw BadData("speed: the blade tips move at " + format_number(tip) + " m/s, must be below " +
                format_number(kSpeedOfSound) + ", the speed of sound; are the unit and the radius right?");
}

// Momentum theory: the power for a thrust T at hover is at least T sqrt(T / (2 rho A)).
double figure_of_merit(double thrust_factor, double torque_factor, const Propeller& propeller) {
  const double area = M_PI * propeller.radius_m * propeller.radius_m;
  return std::pow(thrust_factor, 1.5) / (torque_factor * std::sqrt(2.0 * propeller.air_density * area));
}

}  // namespace

PropellerCoefficients propeller_coefficients(const std::optional<ParameterEstimate>& thrust_factor,
                                             const std::optional<ParameterEstimate>& torque_factor,
                                             const Propeller& propeller, double top_speed) {
  check_tips(propeller, top_speed);
  const plant::BladeCoefficients of_one =
      plant::blade_coefficients({1.0, 1.0}, propeller.radius_m, propeller.air_density);
  PropellerCoefficients out;
  if (thrust_factor) {
    out.thrust = scaled(*thrust_factor, of_one.thrust, "rotor.thrust_coefficient", "C_T");
    const double c_t = out.thrust->value;
    if (!(c_t >= kLeastThrustCoefficient && c_t <= kMostThrustCoefficient)) {
      throw BadData("thrust: leads to C_T = " + format_number(c_t) + " by Eq. (23), must be " +
                    format_number(kLeastThrustCoefficient) + " to " + format_number(kMostThrustCoefficient) +
                    "; are the units of speed, thrust and radius right?");
    }
  }
  if (torque_factor) out.torque = scaled(*torque_factor, of_one.torque, "rotor.torque_coefficient", "C_Q");
  if (thrust_factor && torque_factor) {
    out.figure_of_merit = figure_of_merit(thrust_factor->value, torque_factor->value, propeller);
    if (*out.figure_of_merit > 1.0) {
      throw BadData("thrust: leads to a figure of merit of " + format_number(*out.figure_of_merit) +
                    ", must be at most 1: no propeller gives more thrust than momentum theory; are the units "
                    "of speed, thrust and torque right?");
    }
  }
  return out;
}

void require_possible_rotor(const std::optional<ParameterEstimate>& thrust_factor,
                            const std::optional<ParameterEstimate>& torque_factor, const Propeller& largest) {
  const std::string rotor = "the largest propeller that fits between the base vehicle's hubs (radius " +
                            format_number(largest.radius_m) + " m) ";
  if (!thrust_factor) return;
  const double c_t =
      plant::blade_coefficients({thrust_factor->value, 0.0}, largest.radius_m, largest.air_density).thrust;
  if (c_t > kMostThrustCoefficient) {
    throw BadData("thrust: " + rotor + "would need C_T = " + format_number(c_t) +
                  " by Eq. (23), must be at most " + format_number(kMostThrustCoefficient) +
                  "; are the units of speed and thrust right?");
  }
  if (!torque_factor) return;
  const double merit = figure_of_merit(thrust_factor->value, torque_factor->value, largest);
  if (merit > 1.0) {
    throw BadData(
        "thrust: " + rotor + "would need a figure of merit of " + format_number(merit) +
        ", must be at most 1: no propeller gives more thrust than momentum theory; are the units of speed, "
        "thrust and torque right?");
  }
}

}  // namespace swiftlet::identification

// Propeller coefficients from what its rotor was found to do, Eq. (23) and (24), and whether a propeller can
// do that.
#pragma once

#include <optional>

#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::identification {

struct Propeller {
  double radius_m = 0.0;     // r
  double air_density = 0.0;  // rho, kg/m^3
};

struct PropellerCoefficients {
  std::optional<ParameterEstimate> thrust;  // C_T
  std::optional<ParameterEstimate> torque;  // C_Q
  std::optional<double> figure_of_merit;    // ideal over real power at hover, by momentum theory
};

// From estimates of k_T and k_Q; radius and density count as exact. top_speed: the fastest measured, rad/s.
// Throws BadData for what physics excludes: tips faster than sound, a figure of merit above 1 (more thrust
// than the power can give), a C_T that no propeller reaches.
PropellerCoefficients propeller_coefficients(const std::optional<ParameterEstimate>& thrust_factor,
                                             const std::optional<ParameterEstimate>& torque_factor,
                                             const Propeller& propeller, double top_speed);

// Where the propeller is not known: throws BadData if even the largest that could turn there, of radius_m,
// cannot do what was found, by C_T and figure of merit.
void require_possible_rotor(const std::optional<ParameterEstimate>& thrust_factor,
                            const std::optional<ParameterEstimate>& torque_factor, const Propeller& largest);

}  // namespace swiftlet::identification

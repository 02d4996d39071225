// Converts k_T and k_Q to propeller coefficients, Eq. (23) and (24), and checks that a propeller can reach
// them.
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
  std::optional<double> figure_of_merit;    // ideal over real power at hover, momentum theory
};

// Takes estimates of k_T and k_Q; radius and density are exact. top_speed is the highest measured speed,
// rad/s. Throws BadData for results that physics excludes: blade tips faster than sound, a figure of merit
// above 1 (more thrust than the power can give), a C_T that no propeller reaches.
PropellerCoefficients propeller_coefficients(const std::optional<ParameterEstimate>& thrust_factor,
                                             const std::optional<ParameterEstimate>& torque_factor,
                                             const Propeller& propeller, double top_speed);

// For an unknown propeller: throws BadData if C_T or the figure of merit is impossible even for the largest
// propeller that fits the vehicle.
void require_possible_rotor(const std::optional<ParameterEstimate>& thrust_factor,
                            const std::optional<ParameterEstimate>& torque_factor, const Propeller& largest);

}  // namespace swiftlet::identification

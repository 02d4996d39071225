// Uncertainty of a vehicle's identified parameters.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace swiftlet::plant {

// Keys of the diagonal elements of the inertia: x, y, z.
inline constexpr std::array<const char*, 3> kInertiaKeys = {"inertia.xx", "inertia.yy", "inertia.zz"};

// Uncertainty of one parameter, named by its key in the vehicle file ("motor.k2") or by one of kInertiaKeys.
struct ParameterUncertainty {
  std::string parameter;
  double standard_error = 0.0;  // in the unit of the parameter
  double low = 0.0;             // lower end of the 95 % interval
  double high = 0.0;            // upper end
};

// Correlation between the errors of two parameters, -1 .. 1. The errors of K2 and K3 nearly cancel: sampling
// them independently gives motors that contradict the measurements.
struct ParameterCorrelation {
  std::string first;
  std::string second;
  double value = 0.0;
};

// The uncertainty of parameters not listed here is unknown.
struct VehicleUncertainty {
  std::vector<ParameterUncertainty> parameters;
  std::vector<ParameterCorrelation> correlations;
};

}  // namespace swiftlet::plant

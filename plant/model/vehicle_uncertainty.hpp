// How sure the parameters of a vehicle are.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace swiftlet::plant {

// The diagonal of the inertia, x, y, z.
inline constexpr std::array<const char*, 3> kInertiaKeys = {"inertia.xx", "inertia.yy", "inertia.zz"};

// A parameter by its key in the vehicle file, "motor.k2", or one of kInertiaKeys.
struct ParameterUncertainty {
  std::string parameter;
  double standard_error = 0.0;  // in the unit of the parameter
  double low = 0.0;             // 95 % interval
  double high = 0.0;
};

// Between the errors of two parameters, -1 .. 1. Those of K2 and K3 nearly cancel: whoever draws them apart
// draws motors that nobody has measured.
struct ParameterCorrelation {
  std::string first;
  std::string second;
  double value = 0.0;
};

// Parameters that do not stand here are estimates of unknown quality.
struct VehicleUncertainty {
  std::vector<ParameterUncertainty> parameters;
  std::vector<ParameterCorrelation> correlations;
};

}  // namespace swiftlet::plant

#include "swiftlet/identification/bench/throttle_thrust.hpp"

#include <array>
#include <cmath>

#include <ceres/jet.h>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/curve_fit.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastThrottleThrustRows = 8;

enum Part : std::size_t { kGain, kOffset, kK2, kK3, kThrustFactor, kParts };
constexpr std::array<ParameterName, kParts> kNames = {{{"esc.gain", "gain", "1"},
                                                       {"esc.offset", "offset", "V^2"},
                                                       {"motor.k2", "K2", "V*s/rad"},
                                                       {"motor.k3", "K3", "V*s^2/rad^2"},
                                                       {"rotor.thrust_factor", "k_T", "N*s^2"}}};
using ThrustJet = ceres::Jet<double, kParts + 1>;  // derivatives by the parts and v_s
constexpr double kLeastSquare = 1e-9;              // V^2, keeps the square root away from 0

ThrustJet thrust(const std::array<ThrustJet, kParts>& part, const ThrustJet& supply, double throttle) {
  const ThrustJet square = part[kGain] * supply * supply * throttle + part[kOffset];
  if (square < ThrustJet(kLeastSquare)) return ThrustJet(0.0);
  const ThrustJet voltage = sqrt(square);
  const ThrustJet speed =
      2.0 * voltage / (part[kK2] + sqrt(part[kK2] * part[kK2] + 4.0 * part[kK3] * voltage));
  return part[kThrustFactor] * speed * speed;
}

std::array<double, kParts> parts_of(const plant::Vehicle& vehicle) {
  return {vehicle.esc.gain, vehicle.esc.offset_v2, vehicle.motor.k2, vehicle.motor.k3, vehicle.rotor.thrust};
}

std::vector<Part> free_parts(const KnownParts& known) {
  std::vector<Part> free;
  if (!known.esc) {
    if (known.steady_motor) free.push_back(kGain);
    free.push_back(kOffset);
  }
  if (!known.steady_motor) {
    free.push_back(kK2);
    free.push_back(kK3);
  }
  if (known.esc && known.steady_motor) free.push_back(kThrustFactor);
  return free;
}

void check(const ThrottleThrustData& data) {
  const Column supply{"supply_voltage", "V", data.supply_voltage_v};
  const Column throttle{"throttle", "", data.throttle};
  const Column reading{"thrust", "N", data.thrust_n};
  require_rows({supply, throttle, reading}, kLeastThrottleThrustRows);
  require_drive(supply, throttle);
  require_variety(throttle, 4);
  require_variety(reading, 4);
}

void warn_of_fixed_parts(const KnownParts& known, Experiment& out) {
  if (known.esc && known.steady_motor) return;
  std::string held = known.thrust ? "k_T of thrust_torque" : "k_T of the base vehicle";
  if (!known.esc && !known.steady_motor) held += " and the ESC's gain of the base vehicle";
  out.warnings.push_back(
      "thrust without speed does not identify K2, K3, k_T and the ESC's gain separately: " + held +
      (known.esc || known.steady_motor ? " is held fixed" : " are held fixed") +
      "; the chain from throttle to thrust is valid, its parts only as far as the fixed values are");
}

}  // namespace

Experiment identify_throttle_thrust(const ThrottleThrustData& data, const plant::Vehicle& vehicle,
                                    const KnownParts& known, const Instruments& instruments) {
  check(data);
  const std::vector<Part> free = free_parts(known);
  const std::array<double, kParts> held = parts_of(vehicle);
  const Curve curve = [&](std::size_t row, double supply, const Eigen::VectorXd& p, Gradient& by) {
    std::array<ThrustJet, kParts> part;
    for (std::size_t i = 0; i < kParts; ++i) part[i] = ThrustJet(held[i]);
    for (std::size_t i = 0; i < free.size(); ++i)
      part[free[i]] = ThrustJet(p[static_cast<Eigen::Index>(i)], static_cast<int>(free[i]));
    const ThrustJet value = thrust(part, ThrustJet(supply, kParts), data.throttle[row]);
    for (std::size_t i = 0; i < free.size(); ++i)
      by[static_cast<Eigen::Index>(i)] = value.v[static_cast<Eigen::Index>(free[i])];
    return CurveValue{value.a, value.v[kParts]};
  };

  Eigen::VectorXd start(static_cast<Eigen::Index>(free.size()));
  std::vector<ParameterName> names;
  for (std::size_t i = 0; i < free.size(); ++i) {
    start[static_cast<Eigen::Index>(i)] = held[free[i]] != 0.0 ? held[free[i]] : 1e-2;
    names.push_back(kNames[free[i]]);
  }
  const SpreadRatio spread =
      spreads(instruments.supply_voltage_v, data.supply_voltage_v, instruments.thrust_n, data.thrust_n);
  const Readings readings{data.supply_voltage_v, data.thrust_n, spread.x_spread, spread.y_spread};
  const Fit fit = fit_curve(readings, start, curve);
  Experiment out = conclude(fit, names, data.thrust_n, predicted(readings, fit.parameters, curve), "N");
  for (const ParameterEstimate& estimate : out.estimates) {
    if (estimate.value > 0.0 || estimate.parameter == "esc.offset") continue;
    throw BadData("thrust: leads to " + estimate.symbol + " = " + format_number(estimate.value) + " " +
                  estimate.unit + ", must be above 0; is the thrust that of one rotor, and its unit right?");
  }
  warn_of_fixed_parts(known, out);
  return out;
}

}  // namespace swiftlet::identification

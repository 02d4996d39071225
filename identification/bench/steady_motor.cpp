#include "swiftlet/identification/bench/steady_motor.hpp"

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/curve_fit.hpp"
#include "swiftlet/identification/fitting/limits.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastSteadyMotorRows = 6;

// Eq. (22). A third parameter adds a constant voltage.
CurveValue steady_voltage(std::size_t /*row*/, double speed, const Eigen::VectorXd& p, Gradient& by) {
  by[0] = speed;
  by[1] = speed * speed;
  if (p.size() > 2) by[2] = 1.0;
  return {p[0] * speed + p[1] * speed * speed + (p.size() > 2 ? p[2] : 0.0), p[0] + 2.0 * p[1] * speed};
}

void check(const SteadyMotorData& data) {
  const Column voltage{"motor_voltage", "V", data.motor_voltage_v};
  const Column speed{"speed", "rad/s", data.speed_rad_s};
  require_rows({voltage, speed}, kLeastSteadyMotorRows);
  require_variety(voltage, 3);
  require_variety(speed, 3);
  require_median_between(voltage, kLeastMotorVoltage, kMostMotorVoltage, "no vehicle flies on less or more");
  require_median_between(speed, kLeastRotorSpeed, kMostRotorSpeed, "no rotor turns slower or faster");
}

}  // namespace

Experiment identify_steady_motor(const SteadyMotorData& data, const Instruments& instruments) {
  check(data);
  const SpreadRatio spread =
      spreads(instruments.speed_rad_s, data.speed_rad_s, instruments.motor_voltage_v, data.motor_voltage_v);
  const Readings readings{data.speed_rad_s, data.motor_voltage_v, spread.x_spread, spread.y_spread};
  const double voltage = full_scale(data.motor_voltage_v);
  const double speed = full_scale(data.speed_rad_s);
  const Eigen::Vector2d start(0.5 * voltage / speed, 0.5 * voltage / (speed * speed));
  const Fit fit = fit_curve(readings, start, steady_voltage);

  Experiment out = conclude(fit, {{"motor.k2", "K2", "V*s/rad"}, {"motor.k3", "K3", "V*s^2/rad^2"}},
                            data.motor_voltage_v, predicted(readings, fit.parameters, steady_voltage), "V");
  for (const ParameterEstimate& estimate : out.estimates) {
    if (estimate.value > 0.0) continue;
    throw BadData("speed: leads to " + estimate.symbol + " = " + format_number(estimate.value) + " " +
                  estimate.unit +
                  ", must be above 0 by Eq. (21); were voltage and speed read with the rotor mounted?");
  }
  const Fit with_friction =
      fit_curve(readings, Eigen::Vector3d(start[0], start[1], 0.1 * voltage), steady_voltage);
  if (asks_for_last(with_friction, voltage)) {
    out.warnings.push_back("a constant of " + format_number(with_friction.parameters[2]) +
                           " V added to Eq. (22) is significant: Coulomb friction, a tachometer with an "
                           "offset, or readings of two motors");
  }
  return out;
}

}  // namespace swiftlet::identification

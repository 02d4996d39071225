#include "swiftlet/identification/bench/thrust_torque.hpp"

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/curve_fit.hpp"
#include "swiftlet/identification/fitting/limits.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastThrustTorqueRows = 5;

// Eq. (25) or (26). A second parameter adds a constant.
CurveValue square_law(std::size_t /*row*/, double speed, const Eigen::VectorXd& p, Gradient& by) {
  by[0] = speed * speed;
  if (p.size() > 1) by[1] = 1.0;
  return {p[0] * speed * speed + (p.size() > 1 ? p[1] : 0.0), 2.0 * p[0] * speed};
}

Experiment identify_factor(const std::vector<double>& speeds, const Column& reading,
                           const ParameterName& name, const SpreadRatio& spread) {
  require_variety(reading, 3);
  const Readings readings{speeds, reading.values, spread.x_spread, spread.y_spread};
  const double speed = full_scale(speeds);
  const Eigen::VectorXd start = Eigen::VectorXd::Constant(1, full_scale(reading.values) / (speed * speed));
  const Fit fit = fit_curve(readings, start, square_law);
  if (!(fit.parameters[0] > 0.0)) {
    throw BadData(std::string(reading.name) + ": leads to " + name.symbol + " = " +
                  format_number(fit.parameters[0]) + " " + name.unit +
                  ", must be above 0; is the sign of the column right?");
  }
  Experiment out =
      conclude(fit, {name}, reading.values, predicted(readings, fit.parameters, square_law), reading.unit);
  const Fit with_offset =
      fit_curve(readings, Eigen::Vector2d(start[0], 0.1 * full_scale(reading.values)), square_law);
  if (asks_for_last(with_offset, full_scale(reading.values))) {
    out.warnings.push_back("a constant of " + format_number(with_offset.parameters[1]) + " " + reading.unit +
                           " added to " + name.symbol +
                           " Omega^2 is significant: was the sensor zeroed with the rotor stopped?");
  }
  return out;
}

}  // namespace

ThrustTorque identify_thrust_torque(const ThrustTorqueData& data, const Instruments& instruments) {
  const Column speed{"speed", "rad/s", data.speed_rad_s};
  const Column thrust{"thrust", "N", data.thrust_n};
  const Column torque{"torque", "N*m", data.torque_n_m};
  std::vector<Column> columns = {speed};
  if (!data.thrust_n.empty()) columns.push_back(thrust);
  if (!data.torque_n_m.empty()) columns.push_back(torque);
  if (columns.size() < 2) throw BadData("has neither thrust nor torque, must have at least one");
  require_rows(columns, kLeastThrustTorqueRows);
  require_variety(speed, 3);
  require_median_between(speed, kLeastRotorSpeed, kMostRotorSpeed, "no rotor turns slower or faster");

  ThrustTorque out;
  if (!data.thrust_n.empty()) {
    out.thrust = identify_factor(
        data.speed_rad_s, thrust, {"rotor.thrust_factor", "k_T", "N*s^2"},
        spreads(instruments.speed_rad_s, data.speed_rad_s, instruments.thrust_n, data.thrust_n));
  }
  if (!data.torque_n_m.empty()) {
    out.torque = identify_factor(
        data.speed_rad_s, torque, {"rotor.torque_factor", "k_Q", "N*m*s^2"},
        spreads(instruments.speed_rad_s, data.speed_rad_s, instruments.torque_n_m, data.torque_n_m));
  }
  if (out.thrust && out.torque) {
    const double arm = out.torque->estimates[0].value / out.thrust->estimates[0].value;
    if (!(arm >= kLeastTorquePerThrust && arm <= kMostTorquePerThrust)) {
      throw BadData("torque: is " + format_number(arm) + " m times the thrust, must be " +
                    format_number(kLeastTorquePerThrust) + " to " + format_number(kMostTorquePerThrust) +
                    " m, some tenths of the rotor radius; are the units of both columns right?");
    }
  }
  return out;
}

}  // namespace swiftlet::identification

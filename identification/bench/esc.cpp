#include "swiftlet/identification/bench/esc.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/curve_fit.hpp"
#include "swiftlet/identification/fitting/limits.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastEscRows = 6;
constexpr double kMeterError = 1.1;         // v_a over v_s, largest ratio that two meters' errors explain
constexpr double kLeastSquareShare = 1e-6;  // of full-scale v_a^2; below it the model gives v_a = 0

// Eq. (9). A third parameter adds a term in (v_s^2 delta)^2.
Curve esc_curve(const EscData& data, double least_square) {
  return [&data, least_square](std::size_t row, double supply, const Eigen::VectorXd& p, Gradient& by) {
    const double delta = data.throttle[row];
    const double drive = supply * supply * delta;
    const double bend = p.size() > 2 ? p[2] : 0.0;
    const double square = p[0] * drive + p[1] + bend * drive * drive;
    CurveValue out;
    if (square < least_square) {
      by.setZero();
      return out;
    }
    out.y = std::sqrt(square);
    out.slope = (p[0] + 2.0 * bend * drive) * supply * delta / out.y;
    by[0] = 0.5 * drive / out.y;
    by[1] = 0.5 / out.y;
    if (p.size() > 2) by[2] = 0.5 * drive * drive / out.y;
    return out;
  };
}

void check(const EscData& data) {
  const Column supply{"supply_voltage", "V", data.supply_voltage_v};
  const Column throttle{"throttle", "", data.throttle};
  const Column voltage{"motor_voltage", "V", data.motor_voltage_v};
  require_rows({supply, throttle, voltage}, kLeastEscRows);
  require_drive(supply, throttle);
  require_variety(throttle, 3);
  require_variety(voltage, 3);
  std::vector<double> ratios;
  for (std::size_t i = 0; i < data.throttle.size(); ++i)
    ratios.push_back(data.motor_voltage_v[i] / data.supply_voltage_v[i]);
  if (const double ratio = median(ratios); !(ratio > 0.0 && ratio <= kMeterError)) {
    throw BadData("motor_voltage: its median is " + format_number(ratio) +
                  " times the supply voltage, must be above 0 and at most " + format_number(kMeterError) +
                  ": an ESC cannot raise its supply; are the units of both columns right?");
  }
}

}  // namespace

NaiveEsc naive_esc(const EscData& data, const std::vector<std::size_t>& outliers) {
  const auto drive = [&](std::size_t i) { return data.supply_voltage_v[i] * data.throttle[i]; };
  const auto inside = [&](std::size_t i) { return !std::binary_search(outliers.begin(), outliers.end(), i); };
  double product = 0.0;
  double square = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < data.throttle.size(); ++i) {
    if (!inside(i)) continue;
    product += drive(i) * data.motor_voltage_v[i];
    square += drive(i) * drive(i);
    count += 1.0;
  }
  NaiveEsc out;
  out.factor = product / square;
  double rest = 0.0;
  for (std::size_t i = 0; i < data.throttle.size(); ++i) {
    if (inside(i)) rest += std::pow(data.motor_voltage_v[i] - out.factor * drive(i), 2);
  }
  out.residual_sd_v = std::sqrt(rest / (count - 1.0));
  return out;
}

Experiment identify_esc(const EscData& data, const Instruments& instruments) {
  check(data);
  const SpreadRatio spread = spreads(instruments.supply_voltage_v, data.supply_voltage_v,
                                     instruments.motor_voltage_v, data.motor_voltage_v);
  const Readings readings{data.supply_voltage_v, data.motor_voltage_v, spread.x_spread, spread.y_spread};
  const double full_square = std::pow(full_scale(data.motor_voltage_v), 2);
  const double full_drive = std::pow(full_scale(data.supply_voltage_v), 2);
  const Curve curve = esc_curve(data, kLeastSquareShare * full_square);
  const Fit line = fit_curve(readings, Eigen::Vector2d(full_square / full_drive, 0.05 * full_square), curve);

  std::vector<double> squares;
  std::vector<double> predicted_squares;
  double rest = 0.0;
  for (std::size_t i = 0; i < data.throttle.size(); ++i) {
    const double drive = data.supply_voltage_v[i] * data.supply_voltage_v[i] * data.throttle[i];
    squares.push_back(data.motor_voltage_v[i] * data.motor_voltage_v[i]);
    predicted_squares.push_back(line.parameters[0] * drive + line.parameters[1]);
    if (line.is_outlier(i)) continue;
    const double voltage = std::sqrt(std::max(predicted_squares.back(), 0.0));
    rest += std::pow(data.motor_voltage_v[i] - voltage, 2);
  }
  Experiment out = conclude(line, {{"esc.gain", "gain", "1"}, {"esc.offset", "offset", "V^2"}}, squares,
                            predicted_squares, "V^2");

  const NaiveEsc naive = naive_esc(data, out.outliers);
  const double residual_sd_v = std::sqrt(rest / line.degrees_of_freedom);
  out.findings.push_back("Eq. (9) leaves " + format_number(residual_sd_v) +
                         " V (standard deviation of residuals); the naive v_a = c v_s delta, with c = " +
                         format_number(naive.factor) + ", leaves " + format_number(naive.residual_sd_v) +
                         " V: " + (residual_sd_v < naive.residual_sd_v ? "Eq. (9)" : "the naive one") +
                         " fits better");

  const Fit bent = fit_curve(
      readings,
      Eigen::Vector3d(line.parameters[0], line.parameters[1], 0.1 * full_square / (full_drive * full_drive)),
      curve);
  if (asks_for_last(bent, full_square / (full_drive * full_drive))) {
    out.warnings.emplace_back(
        "v_a^2 over v_s^2 delta is not quite a straight line: a term in (v_s^2 delta)^2 is significant; "
        "Eq. (9) holds only within the range of these data");
  }
  const double supply_v = median(data.supply_voltage_v);
  const double full_share =
      std::sqrt(std::max(line.parameters[0] + line.parameters[1] / (supply_v * supply_v), 0.0));
  if (full_share > kMostOfSupply) {
    throw BadData("throttle: at full throttle the ESC would give " + format_number(full_share) +
                  " times its supply, must be at most " + format_number(kMostOfSupply) +
                  "; is the unit of throttle right?");
  }
  if (!(line.parameters[0] > 0.0)) {
    throw BadData("motor_voltage: does not rise with v_s^2 delta: gain is " +
                  format_number(line.parameters[0]) + ", must be above 0");
  }
  return out;
}

}  // namespace swiftlet::identification

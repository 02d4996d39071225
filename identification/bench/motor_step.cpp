#include "swiftlet/identification/bench/motor_step.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/LU>
#include <ceres/jet.h>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/least_squares.hpp"
#include "swiftlet/identification/fitting/limits.hpp"
#include "swiftlet/math/linear_algebra.hpp"
#include "swiftlet/plant/model/airframe.hpp"

namespace swiftlet::identification {

namespace {

constexpr std::size_t kLeastMotorStepRows = 20;
constexpr std::size_t kLeastRiseRows = 6;      // between 10 and 90 % of the step
constexpr std::size_t kLeastRestRows = 3;      // before the step, for the initial speed
constexpr double kRise = 0.63212055882855767;  // 1 - 1/e
constexpr double kLeastStep = 0.1;             // of the final voltage
constexpr double kSettled = 4.0;               // time constants to 98 % of the step
constexpr double kDecisive = 10.0;             // twice the log-likelihood difference that is significant

using std::exp;

// Parameters of both step responses.
enum Parameter : int { kStepTime, kRate, kFinal, kInitial };
constexpr int kParameters = 4;
using StepJet = ceres::Jet<double, kParameters>;

// tau_m dOmega/dt = Omega_ss - Omega; rate is 1 / tau_m.
template <typename T>
T reduced_response(const T* p, double time) {
  const T elapsed = time - p[kStepTime];
  if (elapsed <= T(0.0)) return p[kInitial];
  return p[kFinal] + (p[kInitial] - p[kFinal]) * exp(-p[kRate] * elapsed);
}

// J_r dOmega/dt = k_Q (s - Omega)(Omega + s'), s' = s + K2 / K3, a Riccati equation:
// y = (s - Omega) / (Omega + s') decays at the rate (k_Q / J_r) (s + s'), which is the parameter kRate.
template <typename T>
T physical_response(const T* p, double time, double k2_over_k3) {
  const T elapsed = time - p[kStepTime];
  if (elapsed <= T(0.0)) return p[kInitial];
  const T& s = p[kFinal];
  const T other = s + k2_over_k3;
  const T y = (s - p[kInitial]) / (p[kInitial] + other) * exp(-p[kRate] * elapsed);
  return (s - y * other) / (1.0 + y);
}

struct Levels {
  double initial = 0.0;
  double final = 0.0;
  std::size_t step_row = 0;  // the first row after the step
};

std::vector<double> part(const std::vector<double>& values, std::size_t begin, std::size_t end) {
  return {values.begin() + static_cast<std::ptrdiff_t>(begin),
          values.begin() + static_cast<std::ptrdiff_t>(end)};
}

// The first of three consecutive rows above a level: a single one may be an outlier. values.size() if none.
std::size_t first_above(const std::vector<double>& values, double level) {
  for (std::size_t i = 0; i + 2 < values.size(); ++i) {
    if (values[i] > level && values[i + 1] > level && values[i + 2] > level) return i;
  }
  return values.size();
}

Levels levels_of(const MotorStepData& data) {
  const std::size_t rows = data.time_s.size();
  Levels out;
  out.final = median(part(data.speed_rad_s, rows - rows / 5, rows));
  const std::vector<double>& cause = data.motor_voltage_v.empty() ? data.speed_rad_s : data.motor_voltage_v;
  const double low = median(part(cause, 0, kLeastRestRows));
  const double high = median(part(cause, rows - rows / 5, rows));
  // The step begins where the voltage passes half of its change; without voltage, where the speed passes a
  // tenth of its change.
  const double share = data.motor_voltage_v.empty() ? 0.1 : 0.5;
  if (!data.motor_voltage_v.empty() && !(high - low > kLeastStep * std::abs(high))) {
    throw BadData("motor_voltage: begins at " + format_number(low) + " and ends at " + format_number(high) +
                  " V, must step up, with at least " + std::to_string(kLeastRestRows) +
                  " rows before the step");
  }
  out.step_row = first_above(cause, low + share * (high - low));
  out.initial = out.step_row > 0 && out.step_row < rows ? median(part(data.speed_rad_s, 0, out.step_row))
                                                        : data.speed_rad_s.front();
  return out;
}

void check(const MotorStepData& data) {
  const Column time{"time", "s", data.time_s};
  const Column speed{"speed", "rad/s", data.speed_rad_s};
  std::vector<Column> columns = {time, speed};
  if (!data.motor_voltage_v.empty()) columns.push_back({"motor_voltage", "V", data.motor_voltage_v});
  require_rows(columns, kLeastMotorStepRows);
  for (std::size_t i = 1; i < data.time_s.size(); ++i) {
    if (!(data.time_s[i] > data.time_s[i - 1]))
      throw BadData("time: is " + format_number(data.time_s[i]) + " s after " +
                        format_number(data.time_s[i - 1]) + " s, must rise",
                    i);
  }
  require_variety(speed, 3);
  if (!data.motor_voltage_v.empty()) require_variety(columns.back());
}

void check_step(const MotorStepData& data, const Levels& levels) {
  if (!(levels.final > levels.initial)) {
    throw BadData("speed: goes from " + format_number(levels.initial) + " to " + format_number(levels.final) +
                  " rad/s, must step up");
  }
  if (levels.final < kLeastRotorSpeed || levels.final > kMostRotorSpeed) {
    throw BadData("speed: ends at " + format_number(levels.final) + " rad/s, must be " +
                  format_number(kLeastRotorSpeed) + " to " + format_number(kMostRotorSpeed) +
                  ": no rotor turns slower or faster; is the unit right?");
  }
  if (levels.step_row < kLeastRestRows) {
    throw BadData("time: has " + std::to_string(levels.step_row) +
                  " rows before the step, must have at least " + std::to_string(kLeastRestRows));
  }
  std::size_t rising = 0;
  for (const double speed : data.speed_rad_s) {
    const double share = (speed - levels.initial) / (levels.final - levels.initial);
    if (share > 0.1 && share < 0.9) ++rising;
  }
  if (rising < kLeastRiseRows) {
    throw BadData("speed: has " + std::to_string(rising) +
                  " rows between 10 and 90 % of the step, must have at least " +
                  std::to_string(kLeastRiseRows) + ": sample faster");
  }
}

template <typename Response>
Fit fit_response(const MotorStepData& data, const Eigen::Vector4d& start, const Response& response,
                 const std::function<void()>& on_iteration) {
  FitProblem problem;
  problem.observations = data.time_s.size();
  problem.start = start;
  problem.bad_leverage = false;  // times are exact
  problem.time_series = true;
  problem.on_iteration = on_iteration;
  problem.residuals = [&](const Eigen::VectorXd& p, Eigen::VectorXd& residuals, Eigen::MatrixXd* jacobian) {
    std::array<StepJet, kParameters> jets;
    for (int i = 0; i < kParameters; ++i) jets[static_cast<std::size_t>(i)] = StepJet(p[i], i);
    for (std::size_t row = 0; row < data.time_s.size(); ++row) {
      const auto at = static_cast<Eigen::Index>(row);
      if (jacobian == nullptr) {
        residuals[at] = data.speed_rad_s[row] - response(p.data(), data.time_s[row]);
        continue;
      }
      const StepJet value = response(jets.data(), data.time_s[row]);
      residuals[at] = data.speed_rad_s[row] - value.a;
      jacobian->row(at) = -value.v.transpose();
    }
  };
  return fit(problem);
}

template <typename Response>
std::vector<double> curve_of(const MotorStepData& data, const Fit& fit, const Response& response) {
  std::vector<double> out;
  out.reserve(data.time_s.size());
  for (const double time : data.time_s) out.push_back(response(fit.parameters.data(), time));
  return out;
}

// The estimate of the time factor / rate, s.
ParameterEstimate time_from_rate(const Fit& fit, double factor, const char* parameter, const char* symbol) {
  const double rate = fit.parameters[kRate];
  const double error = factor * fit.standard_error(kRate) / (rate * rate);
  return {parameter, symbol, "s", factor / rate, error, interval_factor(fit.degrees_of_freedom) * error};
}

// The experiment of one model. Estimates the time constant alone; the other parameters describe this step.
Experiment experiment_of(const MotorStepData& data, const Fit& fit, std::vector<double> curve,
                         const ParameterEstimate& time) {
  Experiment out = conclude(fit,
                            {{"step_time", "t_0", "s"},
                             {"rate", "1/tau", "1/s"},
                             {"final_speed", "Omega_1", "rad/s"},
                             {"initial_speed", "Omega_0", "rad/s"}},
                            data.speed_rad_s, std::move(curve), "rad/s");
  out.estimates = {time};
  out.covariance = Eigen::MatrixXd::Constant(1, 1, time.standard_error * time.standard_error);
  // A step from 0 rad/s or at 0 s is valid: removes the warnings of an estimate that is not different from 0.
  out.warnings.erase(
      std::remove_if(out.warnings.begin(), out.warnings.end(),
                     [](const std::string& text) { return text.find("from 0") != std::string::npos; }),
      out.warnings.end());
  return out;
}

double log_likelihood_gain(const Experiment& better, const Experiment& worse) {
  const auto rows = static_cast<double>(better.measured.size() - better.outliers.size());
  return 2.0 * rows * std::log(worse.residual_sd / better.residual_sd);
}

// Reads tau_m off as the time to 63.2 % of the step, where a parabola through the readings nearby crosses
// that level. Levels and step time are those of the model that fits better.
ParameterEstimate read_off(const MotorStepData& data, const Fit& fit, const Experiment& model) {
  const double initial = fit.parameters[kInitial];
  const double final_speed = fit.parameters[kFinal];
  const double level = initial + kRise * (final_speed - initial);
  const auto crossing = static_cast<std::size_t>(
      std::find_if(model.predicted.begin(), model.predicted.end(), [&](double y) { return y >= level; }) -
      model.predicted.begin());
  const double around = data.time_s[std::min(crossing, data.time_s.size() - 1)];
  const double start = fit.parameters[kStepTime];
  const double half_window = 0.4 * (around - start);

  std::vector<std::size_t> rows;
  for (std::size_t i = 0; i < data.time_s.size(); ++i) {
    if (std::abs(data.time_s[i] - around) <= half_window && !model.is_outlier(i)) rows.push_back(i);
  }
  if (rows.size() < 5) throw BadData("speed: has fewer than 5 rows around 63.2 % of the step: sample faster");
  const auto count = static_cast<Eigen::Index>(rows.size());
  Eigen::MatrixX3d powers(count, 3);
  Eigen::VectorXd speeds(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double u = (data.time_s[rows[static_cast<std::size_t>(i)]] - around) / half_window;
    powers.row(i) << 1.0, u, u * u;
    speeds[i] = data.speed_rad_s[rows[static_cast<std::size_t>(i)]];
  }
  const Eigen::Vector3d c = math::least_squares(powers, speeds);
  const double sigma = (speeds - powers * c).norm() / std::sqrt(static_cast<double>(count - 3));
  double u = 0.0;
  for (int i = 0; i < 20; ++i) u -= (c[0] + c[1] * u + c[2] * u * u - level) / (c[1] + 2.0 * c[2] * u);
  u = std::clamp(u, -1.0, 1.0);
  const double slope = (c[1] + 2.0 * c[2] * u) / half_window;
  const Eigen::Vector3d at(1.0, u, u * u);
  const double speed_error = sigma * std::sqrt(at.dot((powers.transpose() * powers).inverse() * at));
  const double level_error = kRise * fit.standard_error(kFinal);
  const double error =
      std::hypot(std::hypot(speed_error, level_error) / slope, fit.standard_error(kStepTime));
  return {"motor_step.reading",
          "tau_m",
          "s",
          around + half_window * u - start,
          error,
          interval_factor(static_cast<int>(count - 3)) * error};
}

void check_time(const ParameterEstimate& time) {
  if (time.value >= kLeastTimeConstant && time.value <= kMostTimeConstant) return;
  throw BadData("time: leads to tau_m = " + format_number(time.value) + " s, must be " +
                format_number(kLeastTimeConstant) + " to " + format_number(kMostTimeConstant) +
                " s: no motor with a rotor is faster or slower; is the unit right?");
}

void warn_of_short_record(const MotorStepData& data, const Fit& fit, Experiment& experiment) {
  const double after = (data.time_s.back() - fit.parameters[kStepTime]) * fit.parameters[kRate];
  if (after >= kSettled) return;
  experiment.warnings.push_back("the record ends " + format_number(after) +
                                " time constants after the step, should end at least " +
                                format_number(kSettled) + " after it: the final speed is extrapolated");
}

}  // namespace

MotorStep identify_motor_step(const MotorStepData& data, const plant::Vehicle& vehicle,
                              double torque_factor_error, const std::function<void()>& on_iteration) {
  check(data);
  const Levels levels = levels_of(data);
  check_step(data, levels);
  const double step_time = 0.5 * (data.time_s[levels.step_row - 1] + data.time_s[levels.step_row]);
  const std::size_t risen =
      first_above(data.speed_rad_s, levels.initial + kRise * (levels.final - levels.initial));
  const double rise_time = data.time_s[std::min(risen, data.time_s.size() - 1)] - step_time;
  const double sample =
      (data.time_s.back() - data.time_s.front()) / static_cast<double>(data.time_s.size() - 1);

  // Shifts the time to begin shortly before the step, so that the step time is not close to 0.
  MotorStepData shifted = data;
  const double origin = step_time - 10.0 * sample;
  for (double& time : shifted.time_s) time -= origin;
  const Eigen::Vector4d start(step_time - origin, 1.0 / std::max(rise_time, sample), levels.final,
                              std::max(levels.initial, 0.01 * levels.final));

  const auto reduced = [](const auto* p, double time) { return reduced_response(p, time); };
  const double k2_over_k3 = vehicle.motor.k2 / vehicle.motor.k3;
  const auto physical = [k2_over_k3](const auto* p, double time) {
    return physical_response(p, time, k2_over_k3);
  };
  const Fit reduced_fit = fit_response(shifted, start, reduced, on_iteration);
  check_time(time_from_rate(reduced_fit, 1.0, "motor.time_constant", "tau_m"));
  const Fit physical_fit = fit_response(shifted, start, physical, on_iteration);

  // J_r from the rate (k_Q / J_r) (s + s'), and its 63.2 % rise time from rest to hover: the inverse of the
  // computation in plant/model/motor.cpp.
  const double final_speed = physical_fit.parameters[kFinal];
  const double inertia_rate = vehicle.rotor.torque * (2.0 * final_speed + k2_over_k3);  // J_r times the rate
  const double hover = plant::hover_speed(vehicle);
  const double other_root = hover + k2_over_k3;
  const double rise_factor = (2.0 * final_speed + k2_over_k3) / (hover + other_root) *
                             (1.0 + std::log1p(kRise * hover / other_root));

  MotorStep out;
  out.reduced = experiment_of(shifted, reduced_fit, curve_of(shifted, reduced_fit, reduced),
                              time_from_rate(reduced_fit, 1.0, "motor.time_constant", "tau_m"));
  out.physical = experiment_of(shifted, physical_fit, curve_of(shifted, physical_fit, physical),
                               time_from_rate(physical_fit, rise_factor, "motor.time_constant", "tau_m"));
  out.rotor_inertia = time_from_rate(physical_fit, inertia_rate, "motor_step.rotor_inertia", "J_r");
  out.rotor_inertia.unit = "kg*m^2";
  const double relative =
      std::hypot(out.rotor_inertia.standard_error / out.rotor_inertia.value, torque_factor_error);
  out.rotor_inertia.standard_error = relative * out.rotor_inertia.value;
  out.rotor_inertia.half_width =
      interval_factor(physical_fit.degrees_of_freedom) * out.rotor_inertia.standard_error;

  out.physical_fits_better = out.physical.residual_sd < out.reduced.residual_sd;
  Experiment& better = out.physical_fits_better ? out.physical : out.reduced;
  Experiment& worse = out.physical_fits_better ? out.reduced : out.physical;
  out.decided = log_likelihood_gain(better, worse) > kDecisive;
  const Fit& better_fit = out.physical_fits_better ? physical_fit : reduced_fit;
  out.step_time_s = better_fit.parameters[kStepTime] + origin;
  out.reading = read_off(shifted, better_fit, better);
  for (Experiment* experiment : {&out.reduced, &out.physical})
    warn_of_short_record(shifted, experiment == &out.reduced ? reduced_fit : physical_fit, *experiment);
  if (better_fit.serial_correlation > 3.0 / std::sqrt(static_cast<double>(data.time_s.size()))) {
    better.warnings.push_back(
        "neighbouring residuals have a correlation of " + format_number(better_fit.serial_correlation) +
        ": the model is incomplete, or the tachometer filters the speed; the intervals are widened for it");
  }
  out.findings.push_back(
      "the reduced model leaves " + format_number(out.reduced.residual_sd) +
      " rad/s (standard deviation of residuals), the physical model " +
      format_number(out.physical.residual_sd) + " rad/s: " +
      (out.decided
           ? std::string(out.physical_fits_better ? "the physical" : "the reduced") + " model fits better"
           : "the difference is not significant"));
  return out;
}

}  // namespace swiftlet::identification

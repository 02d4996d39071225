#include "swiftlet/identification/flight/command_flight.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "swiftlet/identification/flight/command_fit.hpp"
#include "swiftlet/identification/flight/command_prediction.hpp"
#include "swiftlet/identification/flight/flight_results.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr std::size_t kCurvePoints = 41;
constexpr double kRareCommands = 0.01;  // fraction of commands outside the figure, at each end
constexpr double kNotable = 0.03;       // standard error over the value, of a difference that it warns of
constexpr std::size_t kParts = 3;       // of a single log, that are compared
constexpr double kAtOdds = 1.5;         // Birge's ratio of the lags above which it warns
// Standard error of the sag over the sag: the internal resistance of a lithium polymer battery doubles with age or cold.
constexpr double kBatteryKnown = 0.5;
constexpr double kOneRate = 0.1;      // relative difference of the sample periods of logs
constexpr double kOfLittleUse = 0.1;  // weight of the commands in a forecast that is reported

ParameterEstimate lag_of(const CommandFit& alone) {
  const Index lag = alone.model->layout().lag;
  const double error = alone.fit.standard_error(lag);
  return {response_name(alone.model->responses().front()),      "tau_m", "s", alone.x()[lag], error,
          interval_factor(alone.fit.degrees_of_freedom) * error};
}

// Consistency of several estimates of one quantity.
struct Agreement {
  double standard_error = 0.0;  // of their weighted mean, from their differences
  double ratio = 0.0;           // Birge's ratio: actual over expected differences
};

Agreement agreement(const std::vector<ParameterEstimate>& estimates) {
  double weight = 0.0;
  double mean = 0.0;
  for (const ParameterEstimate& estimate : estimates) {
    const double w = 1.0 / (estimate.standard_error * estimate.standard_error);
    weight += w;
    mean += w * estimate.value;
  }
  mean /= weight;
  double chi_squared = 0.0;
  for (const ParameterEstimate& estimate : estimates)
    chi_squared += std::pow((estimate.value - mean) / estimate.standard_error, 2);
  const double ratio = std::sqrt(chi_squared / static_cast<double>(estimates.size() - 1));
  return {ratio / std::sqrt(weight), ratio};
}

// Raises the standard error of a parameter, and those of the others by their correlations with it.
void widen(EstimatedParameters& fit, Index parameter, double standard_error) {
  const double variance = fit.covariance(parameter, parameter);
  const double wanted = standard_error * standard_error;
  if (wanted <= variance) return;
  const VectorXd follows = fit.covariance.col(parameter) / variance;
  fit.covariance += (wanted - variance) * follows * follows.transpose();
}

// Each log, or thirds of a single one.
std::vector<std::vector<FlightSeries>> parts_of(const std::vector<FlightSeries>& flights) {
  std::vector<std::vector<FlightSeries>> out;
  if (flights.size() > 1) {
    for (const FlightSeries& flight : flights) out.push_back({flight});
    return out;
  }
  const Rows whole = flights.front().estimation_set;
  for (std::size_t part = 0; part < kParts; ++part) {
    FlightSeries series = flights.front();
    series.estimation_set = {whole.first + part * whole.size() / kParts,
                             whole.first + (part + 1) * whole.size() / kParts};
    series.validation_set = {series.estimation_set.last, series.estimation_set.last};
    out.push_back({std::move(series)});
  }
  return out;
}

// Widens the intervals of the gains to the differences between parts of the flights, which show what the model
// omits: battery, airflow, feedback. Returns a sentence for each that differs by more than its interval allows.
std::vector<std::string> widen_by_parts(CommandFit& all, const std::vector<FlightSeries>& flights,
                                        const plant::Vehicle& base, const std::function<void()>& progress) {
  const CommandLayout& l = all.model->layout();
  const std::vector<std::pair<const char*, Index>> compared = {{"the gain about roll", l.gain[0]},
                                                               {"the gain about pitch", l.gain[1]},
                                                               {"the gain about yaw", l.gain[2]}};
  std::vector<std::vector<ParameterEstimate>> found(compared.size());
  const KnownThrust whole = thrust_of(all);
  const std::vector<std::vector<FlightSeries>> parts = parts_of(flights);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const KnownThrust thrust{whole.curve, {whole.drift[flights.size() > 1 ? p : 0]}};
    const CommandFit moments = fit_responses(
        parts[p], base, {Response::kRoll, Response::kPitch, Response::kYaw}, thrust, {&all}, progress);
    for (std::size_t i = 0; i < compared.size(); ++i) {
      const Index at = moments.model->layout().gain[i];
      found[i].push_back({compared[i].first, "", "", moments.x()[at], moments.fit.standard_error(at), 0.0});
    }
  }
  std::vector<std::string> out;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Agreement together = agreement(found[i]);
    if (together.ratio <= 1.0) continue;
    widen(all.fit, compared[i].second, together.standard_error);
    if (together.ratio > kAtOdds &&
        together.standard_error > kNotable * std::abs(all.x()[compared[i].second]))
      out.push_back(
          std::string(compared[i].first) + " differs between " +
          (flights.size() > 1 ? "the logs" : "parts of the log") + " " + format_number(together.ratio) +
          " times as much as its intervals allow: the model does not describe all of the flight; the "
          "interval is widened accordingly");
  }
  return out;
}

// Adds the uncertainty of the base vehicle's supply sag to the gains and the quantities derived from them.
void allow_for_battery(const CommandModel& model, const std::vector<Derived>& quantities,
                       DerivedValues& values) {
  const double relative = kBatteryKnown * (1.0 / model.shared_over_single() - 1.0);
  VectorXd moved = VectorXd::Zero(values.values.size());
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const std::string& name = quantities[i].parameter;
    const auto at = static_cast<Index>(i);
    if (name.rfind("thrust_to_rate.", 0) == 0) moved[at] = relative * values.values[at];
    if (name.rfind("inertia.", 0) == 0 || name.rfind("thrust_centre.", 0) == 0)
      moved[at] = -relative * values.values[at];
  }
  values.covariance += moved * moved.transpose();
}

// The command at which all rotors together carry the weight.
double hover_command(const ThrustCurve& curve) {
  const double missing = plant::kGravity - curve.value;
  const double root = std::sqrt(std::max(curve.slope * curve.slope + 4.0 * curve.curvature * missing, 0.0));
  return curve.middle + 2.0 * missing / (curve.slope + root);
}

std::vector<Derived> derived(const CommandModel& model) {
  const CommandLayout& l = model.layout();
  const plant::Vehicle& base = model.base();
  const auto at = [](int index) { return [index](const VectorXd& x) { return x[index]; }; };
  const auto hover = [&model](const VectorXd& x) { return hover_command(model.curve(x)); };
  const auto slope = [&model, hover](const VectorXd& x) { return model.curve(x).slope_at(hover(x)); };
  std::vector<Derived> out;
  out.push_back({"motor.time_constant", "tau_m", "s", at(l.lag)});
  out.push_back({"delay.force", "T_f", "s", at(l.force_delay)});
  out.push_back({"delay.rates", "T_w", "s", at(l.rate_delay)});
  out.push_back({"lag_and_delay.force", "tau_m + T_f", "s",
                 [&l](const VectorXd& x) { return x[l.lag] + x[l.force_delay]; }});
  out.push_back({"lag_and_delay.rates", "tau_m + T_w", "s",
                 [&l](const VectorXd& x) { return x[l.lag] + x[l.rate_delay]; }});
  out.push_back({"thrust_per_mass.hover_command", "u_h", "1", hover});
  out.push_back({"thrust_per_mass.slope", "a'(u_h)", "m/s^2", slope});
  out.push_back({"thrust_per_mass.curvature", "a''(u_h)/2", "m/s^2", at(l.curve + 2)});
  for (std::size_t log = 0; log < l.drift.size(); ++log) {
    const std::string of_log = l.drift.size() > 1 ? "[" + std::to_string(log) + "]" : "";
    out.push_back({"thrust_per_mass.drift" + of_log, "da/dt/a", "1/s", at(l.drift[log])});
  }
  const char* const gains[3] = {"m d/J_xx", "m d/J_yy", "m k_Q/(k_T J_zz)"};
  for (int axis = 0; axis < 3; ++axis)
    out.push_back({std::string("thrust_to_rate.") + axis_name(axis), gains[axis], "1/m", at(l.gain[axis])});
  const char* const responses[3] = {"dp/dt/u", "dq/dt/u", "dr/dt/u"};
  for (int axis = 0; axis < 3; ++axis) {
    const int gain = l.gain[axis];
    out.push_back({std::string("command_to_rate.") + axis_name(axis), responses[axis], "rad/s^2",
                   [gain, slope, &model](const VectorXd& x) {
                     return x[gain] * slope(x) / model.shared_over_single();
                   }});
  }
  const double rotors = base.rotor_count();
  out.push_back({"lead.yaw", "T_z", "s", [&l, rotors](const VectorXd& x) {
                   return 0.5 * x[l.spin_up] / (x[l.gain[2]] * std::sqrt(plant::kGravity / rotors));
                 }});
  const char* const symbols[3] = {"J_xx", "J_yy", "J_zz"};
  for (int axis = 0; axis < 3; ++axis) {
    const int gain = l.gain[axis];
    const double lever = model.lever(axis);
    out.push_back({plant::kInertiaKeys[static_cast<std::size_t>(axis)], symbols[axis], "kg*m^2",
                   [gain, lever, &base](const VectorXd& x) { return base.mass_kg * lever / x[gain]; }});
  }
  // A thrust T through (x, y) gives the moment (-y T, x T).
  out.push_back({"thrust_centre.x", "r_x", "m",
                 [&l, &model](const VectorXd& x) { return x[l.trim[1]] / x[l.gain[1]] * model.lever(1); }});
  out.push_back({"thrust_centre.y", "r_y", "m",
                 [&l, &model](const VectorXd& x) { return -x[l.trim[0]] / x[l.gain[0]] * model.lever(0); }});
  return out;
}

const ParameterEstimate& named(const FlightIdentification& found, const std::string& parameter) {
  return *found.find(parameter);
}

std::string with_interval(const ParameterEstimate& e) {
  return format_number(e.value) + " +- " + format_number(e.half_width) + " " + e.unit;
}

void compare_with_file(FlightIdentification& out, const CommandModel& model) {
  const plant::Vehicle& base = model.base();
  out.comparisons.push_back({named(out, "motor.time_constant"), base.motor.time_constant_s});
  for (int axis = 0; axis < 3; ++axis) {
    out.comparisons.push_back({named(out, std::string("thrust_to_rate.") + axis_name(axis)),
                               base.mass_kg * model.lever(axis) / base.inertia(axis, axis)});
  }
}

void draw_thrust(FlightIdentification& out, const CommandFit& all) {
  std::vector<double> commands;
  for (const FlightSeries& flight : all.model->flights()) {
    for (std::size_t row = flight.estimation_set.first; row < flight.estimation_set.last; ++row)
      commands.insert(commands.end(), flight.log->command[row].begin(),
                      flight.log->command[row].begin() + flight.log->rotor_count);
  }
  std::sort(commands.begin(), commands.end());
  const auto rare = static_cast<std::size_t>(kRareCommands * static_cast<double>(commands.size()));
  const double low = commands[rare];
  const double high = commands[commands.size() - 1 - rare];
  const ThrustCurve curve = all.model->curve(all.x());
  const Index first = all.model->layout().curve;
  const Eigen::Matrix3d covariance = all.fit.covariance.block<3, 3>(first, first);
  const double factor = interval_factor(all.fit.degrees_of_freedom);
  for (std::size_t i = 0; i < kCurvePoints; ++i) {
    const double command = low + (high - low) * static_cast<double>(i) / (kCurvePoints - 1);
    const double off = command - curve.middle;
    const Eigen::Vector3d gradient(1.0, off, off * off);
    out.thrust.command.push_back(command);
    out.thrust.over_mass.push_back(curve.at(command));
    out.thrust.half_width.push_back(factor * std::sqrt(std::max(gradient.dot(covariance * gradient), 0.0)));
  }
}

// The parameters that are not identifiable for lack of excitation, with the reason. Without excitation of
// roll or pitch, the lag is not identifiable either. Adds a sentence for each gain.
std::map<std::string, std::string> not_identifiable_parameters(FlightIdentification& out,
                                                               const CommandPredictions& predictions) {
  std::map<std::string, std::string> not_identifiable = not_identifiable_axes(predictions.excitations);
  for (int axis = 0; axis < 3; ++axis) {
    const auto calm = not_identifiable.find(plant::kInertiaKeys[static_cast<std::size_t>(axis)]);
    if (calm == not_identifiable.end()) continue;
    if (axis < 2) not_identifiable["motor.time_constant"] = calm->second;
    out.unexcited.push_back(std::string("thrust_to_rate.") + axis_name(axis) + ": " + calm->second);
  }
  return not_identifiable;
}

// All logs share one discrete-time noise model: they need the same sample rate.
void require_one_rate(const std::vector<FlightSeries>& flights) {
  const auto period_s = [](const FlightSeries& flight) {
    const std::vector<double>& time = flight.log->time_s;
    return (time[flight.estimation_set.last - 1] - time[flight.estimation_set.first]) /
           static_cast<double>(flight.estimation_set.size() - 1);
  };
  const double first_s = period_s(flights.front());
  for (const FlightSeries& flight : flights) {
    const double this_s = period_s(flight);
    if (std::abs(this_s / first_s - 1.0) < kOneRate) continue;
    throw BadData(flight.log->name + " has a sample every " + format_number(1e3 * this_s) + " ms and " +
                  flights.front().log->name + " every " + format_number(1e3 * first_s) +
                  " ms: without poses and supply voltage, logs must have the same sample rate");
  }
}

void require_possible_hover(const ParameterEstimate& command) {
  if (command.low() < 1.0 && command.high() > 0.0) return;
  throw BadData("commands: hover is at " + format_number(command.value) +
                " of full command, must be 0 to 1; are the units right?");
}

// What to do to identify the parameter. by_flight holds the intervals without the uncertainty of the battery.
std::string advice(const std::string& parameter, const ParameterEstimate& estimate,
                   const std::vector<ParameterEstimate>& by_flight, const plant::Vehicle& base) {
  for (const ParameterEstimate& alone : by_flight) {
    if (alone.parameter == parameter && alone.half_width < 0.7 * estimate.half_width)
      return "the battery causes most of it: measure the internal resistance of " + base.name + "'s battery";
  }
  for (std::size_t axis = 0; axis < plant::kInertiaKeys.size(); ++axis) {
    if (parameter == plant::kInertiaKeys[axis]) return excitation_advice(axis);
  }
  return "fly quick moves, also up and down";
}

void report_lags(FlightIdentification& out, const Agreement& lags) {
  std::string sentence = "the rotor lag fitted to each response alone: ";
  for (const ParameterEstimate& lag : out.lags)
    sentence += (&lag == &out.lags.front() ? "" : ", ") + with_interval(lag) + " by " + lag.parameter;
  if (lags.ratio > kAtOdds) {
    out.warnings.push_back(
        sentence + "; they differ " + format_number(lags.ratio) +
        " times as much as their intervals allow: a single rotor lag does not describe this flight; "
        "the intervals of tau_m and of the parameters correlated with it are widened accordingly");
  } else {
    out.findings.push_back(sentence);
  }
}

void report_delays(FlightIdentification& out, const CommandFit& all) {
  const CommandLayout& l = all.model->layout();
  out.findings.push_back(
      "correlation of the lag with the delay of the force: " +
      format_number(all.fit.correlation(l.lag, l.force_delay)) +
      ", with the delay of the rates: " + format_number(all.fit.correlation(l.lag, l.rate_delay)) +
      "; delays include the filters of the sensors");
}

void report_forecasts(FlightIdentification& out, const CommandPredictions& predictions) {
  std::string quantities;
  std::string weights;
  for (std::size_t i = 0; i < predictions.errors.size(); ++i) {
    const double weight = predictions.weight_of_commands[i];
    if (weight > kOfLittleUse) continue;
    quantities += (quantities.empty() ? "" : ", ") + predictions.errors[i].quantity;
    weights += (weights.empty() ? "" : ", ") + format_number(weight);
  }
  if (quantities.empty()) return;
  out.findings.push_back("half a second ahead the commands predict little of " + quantities +
                         ": disturbances and the controller's response to them dominate; the forecast uses " +
                         weights + " of the change that the commands predict");
}

}  // namespace

void identify_commands(FlightIdentification& out, const std::vector<FlightSeries>& flights,
                       const plant::Vehicle& base, const FlightOptions& options) {
  const auto progress = [&] {
    if (options.progress) options.progress("fitting");
  };
  require_one_rate(flights);
  const std::vector<CommandFit> alone = fit_alone(flights, base, progress);
  for (const CommandFit& fit : alone) reject_negative_gains(fit.model->layout().gain, base, fit.fit);
  const CommandFit moments = fit_responses(flights, base, {Response::kRoll, Response::kPitch, Response::kYaw},
                                           thrust_of(alone[0]), {&alone[2], &alone[1]}, progress);
  CommandFit all = combined_fit(flights, base, alone[0], moments);
  for (const CommandFit& fit : alone) out.lags.push_back(lag_of(fit));
  const Agreement lags = agreement(out.lags);
  if (lags.ratio > 1.0) widen(all.fit, all.model->layout().lag, lags.standard_error);
  for (std::string& sentence : widen_by_parts(all, flights, base, progress))
    out.warnings.push_back(std::move(sentence));
  reject_negative_gains(all.model->layout().gain, base, all.fit);

  out.converged = all.fit.converged && within_bounds(all.model->physical_parameters(), all.fit);
  const std::vector<Derived> quantities = derived(*all.model);
  DerivedValues values = evaluate(quantities, all.model->layout().parameters, all.fit);
  const std::vector<ParameterEstimate> by_flight =
      estimates_of(quantities, values, all.fit.degrees_of_freedom);
  allow_for_battery(*all.model, quantities, values);
  out.estimates = estimates_of(quantities, values, all.fit.degrees_of_freedom);
  require_possible_hover(*out.find("thrust_per_mass.hover_command"));
  CommandPredictions predictions = command_predictions(*all.model, all.x());
  conclude_vehicle(
      out, values, base, not_identifiable_parameters(out, predictions),
      [&](const std::string& parameter) { return advice(parameter, *out.find(parameter), by_flight, base); });
  out.unexcited.emplace_back(
      "mass, rotor.thrust_factor, rotor.torque_factor, linear_drag and the accelerometer's offset: a log "
      "without poses and supply voltage does not determine them; moments of inertia follow from the mass and "
      "levers of " +
      base.name + " and m d/J");
  out.findings.push_back(
      "a change of all commands changes the thrust " + format_number(all.model->shared_over_single()) +
      " times as much as a change of their differences, as the supply sags: computed with the battery of " +
      base.name + ", and included in m d/J");
  compare_with_file(out, *all.model);
  draw_thrust(out, all);
  report_lags(out, lags);
  report_delays(out, all);
  warn_of_fit(out, all.model->physical_parameters(), all.fit);
  report_forecasts(out, predictions);
  out.step_s = all.model->sample_s();
  out.errors = std::move(predictions.errors);
  out.horizons = std::move(predictions.horizons);
  out.trace = std::move(predictions.trace);
}

}  // namespace swiftlet::identification

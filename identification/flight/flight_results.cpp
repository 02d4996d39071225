#include "swiftlet/identification/flight/flight_results.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/inertia_triangle_inequality.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMostHalfWidth = 0.25;         // half width over value of an identified parameter
constexpr double kMostDragHalfWidth = 0.1;      // 1/s, the same for drag over mass
constexpr double kPlausibilityHalfWidth = 0.5;  // half width over value, to check the value
constexpr double kSmallStep = 1e-4;             // of numerical differentiation, over a parameter's scale
constexpr double kOverNoise = 20.0;             // least change of a rate in half a second, over its noise
constexpr double kNegativeErrors = 3.0;         // standard errors below 0 of a significantly negative gain

const char* const kAxisNames[3] = {"roll", "pitch", "yaw"};

std::string share_text(const ParameterEstimate& estimate) {
  return format_number(100.0 * estimate.half_width / std::max(std::abs(estimate.value), 1e-300)) + " %";
}

bool is_identified(const ParameterEstimate& estimate, const plant::Vehicle& base) {
  if (estimate.parameter == "linear_drag")
    return estimate.half_width < kMostDragHalfWidth * base.mass_kg && estimate.high() > 0.0;
  return estimate.value > 0.0 && estimate.half_width < kMostHalfWidth * estimate.value;
}

void put(plant::Vehicle& vehicle, const std::string& parameter, double value) {
  if (parameter == "motor.time_constant") vehicle.motor.time_constant_s = value;
  if (parameter == "rotor.thrust_factor") vehicle.rotor.thrust = value;
  if (parameter == "mass") vehicle.mass_kg = value;
  if (parameter == "inertia.xx") vehicle.inertia(0, 0) = value;
  if (parameter == "inertia.yy") vehicle.inertia(1, 1) = value;
  if (parameter == "inertia.zz") vehicle.inertia(2, 2) = value;
  if (parameter == "linear_drag") vehicle.linear_drag = std::max(value, 0.0);
}

bool at_bound(const FlightParameter& parameter, double value) {
  const double margin = 1e-6 * (parameter.high - parameter.low);
  return value - parameter.low <= margin || parameter.high - value <= margin;
}

void enforce_inertia_triangle_inequality(FlightIdentification& out) {
  std::array<std::optional<double>, 3> variances;
  for (std::size_t axis = 0; axis < variances.size(); ++axis) {
    const char* const key = plant::kInertiaKeys[axis];
    if (out.sources.count(key) > 0) variances[axis] = std::pow(out.find(key)->standard_error, 2);
  }
  if (const auto moved = enforce_triangle_inequality(out.vehicle.inertia, variances))
    out.warnings.push_back(*moved);
}

// The gains from thrust to a rate of an axis, of which the moment of inertia is not identifiable.
void mark_gains(FlightIdentification& out, const std::map<std::string, std::string>& not_identifiable) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (not_identifiable.count(plant::kInertiaKeys[axis]) == 0) continue;
    for (ParameterEstimate& estimate : out.estimates) {
      if (estimate.parameter == std::string("rotor_to_rate.") + kAxisNames[axis] ||
          estimate.parameter == std::string("thrust_to_rate.") + kAxisNames[axis])
        estimate.identifiable = false;
    }
  }
}

bool is_in_vehicle_file(const std::string& parameter) {
  return parameter == "motor.time_constant" || parameter == "rotor.thrust_factor" || parameter == "mass" ||
         parameter == "linear_drag" || parameter.rfind("inertia.", 0) == 0;
}

}  // namespace

const char* axis_name(int axis) { return kAxisNames[axis]; }

DerivedValues evaluate(const std::vector<Derived>& quantities, const std::vector<FlightParameter>& parameters,
                       const EstimatedParameters& fit) {
  const auto count = static_cast<Index>(quantities.size());
  const Index parameter_count = fit.parameters.size();
  DerivedValues out{VectorXd(count), MatrixXd()};
  MatrixXd gradient(count, parameter_count);
  for (Index i = 0; i < count; ++i) {
    const Derived& quantity = quantities[static_cast<std::size_t>(i)];
    out.values[i] = quantity.of(fit.parameters);
    VectorXd x = fit.parameters;
    for (Index p = 0; p < parameter_count; ++p) {
      const double step = kSmallStep * parameters[static_cast<std::size_t>(p)].scale;
      x[p] = fit.parameters[p] + step;
      const double above = quantity.of(x);
      x[p] = fit.parameters[p] - step;
      gradient(i, p) = (above - quantity.of(x)) / (2.0 * step);
      x[p] = fit.parameters[p];
    }
  }
  out.covariance = gradient * fit.covariance * gradient.transpose();
  return out;
}

std::vector<ParameterEstimate> estimates_of(const std::vector<Derived>& quantities,
                                            const DerivedValues& values, int degrees_of_freedom) {
  const double factor = interval_factor(degrees_of_freedom);
  std::vector<ParameterEstimate> out;
  for (std::size_t i = 0; i < quantities.size(); ++i) {
    const auto at = static_cast<Index>(i);
    const double error = std::sqrt(std::max(values.covariance(at, at), 0.0));
    out.push_back({quantities[i].parameter, quantities[i].symbol, quantities[i].unit, values.values[at],
                   error, factor * error});
  }
  return out;
}

FlightIdentification start_identification(const std::vector<FlightSeries>& flights) {
  FlightIdentification out;
  out.source = flights.front().source;
  for (const FlightSeries& flight : flights) {
    const std::vector<double>& time = flight.log->time_s;
    out.windows.push_back(flight.window);
    out.estimation_set_s += time[flight.estimation_set.last - 1] - time[flight.estimation_set.first];
    out.validation_set_s += time[flight.validation_set.last - 1] - time[flight.validation_set.first];
  }
  return out;
}

std::string excitation_advice(std::size_t axis) {
  constexpr std::array<const char*, 3> kMoves = {
      "fly quick moves sideways", "fly quick moves forward and back", "turn quickly about yaw"};
  return kMoves[axis];
}

std::map<std::string, std::string> not_identifiable_axes(const std::array<RateExcitation, 3>& excitations) {
  std::map<std::string, std::string> out;
  for (std::size_t axis = 0; axis < excitations.size(); ++axis) {
    const RateExcitation& of = excitations[axis];
    if (of.in_half_second > kOverNoise * of.noise) continue;
    out[plant::kInertiaKeys[axis]] = of.quantity + " changes by " + format_number(of.in_half_second) +
                                     " rad/s in half a second, must change by " + format_number(kOverNoise) +
                                     " times the noise, " + format_number(of.noise) + " rad/s; " +
                                     excitation_advice(axis);
  }
  return out;
}

bool within_bounds(const std::vector<FlightParameter>& parameters, const EstimatedParameters& fit) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (at_bound(parameters[i], fit.parameters[static_cast<Index>(i)])) return false;
  }
  return true;
}

void conclude_vehicle(FlightIdentification& out, const DerivedValues& values, const plant::Vehicle& base,
                      const std::map<std::string, std::string>& not_identifiable,
                      const std::function<std::string(const std::string& parameter)>& advice) {
  out.vehicle = base;
  for (const std::size_t axis : {0, 1}) {
    const ParameterEstimate* const found = out.find(plant::kInertiaKeys[axis]);
    if (found != nullptr && found->half_width < kPlausibilityHalfWidth * found->value)
      require_gyration("body rates", *found, base.mass_kg, plant::hub_distance(base));
  }
  if (!out.converged) {
    out.warnings.emplace_back("no estimate is copied to the vehicle");
    return;
  }
  std::vector<Index> written;
  mark_gains(out, not_identifiable);
  for (std::size_t i = 0; i < out.estimates.size(); ++i) {
    ParameterEstimate& estimate = out.estimates[i];
    if (!is_in_vehicle_file(estimate.parameter)) continue;
    if (const auto reason = not_identifiable.find(estimate.parameter); reason != not_identifiable.end()) {
      estimate.identifiable = false;
      out.unexcited.push_back(estimate.parameter + ": " + reason->second);
      continue;
    }
    if (!is_identified(estimate, base)) {
      if (estimate.parameter == "linear_drag" && estimate.high() <= 0.0) {
        out.warnings.push_back("linear_drag is significantly negative, " + format_number(estimate.value) +
                               " +- " + format_number(estimate.half_width) +
                               " N*s/m: it is not written; are the frames of poses and IMU right?");
        continue;
      }
      estimate.identifiable = false;
      out.unexcited.push_back(estimate.parameter + ": its interval is +- " + share_text(estimate) +
                              " of the value: " + advice(estimate.parameter));
      continue;
    }
    put(out.vehicle, estimate.parameter, estimate.value);
    const double least = estimate.parameter == "linear_drag" ? 0.0 : -std::numeric_limits<double>::infinity();
    out.uncertainty.parameters.push_back(
        {estimate.parameter, estimate.standard_error, std::max(estimate.low(), least), estimate.high()});
    out.sources[estimate.parameter] = "identified from " + std::to_string(out.windows.size()) +
                                      (out.windows.size() == 1 ? " flight" : " flights") + ", +- " +
                                      share_text(estimate);
    written.push_back(static_cast<Index>(i));
  }
  for (FileComparison& comparison : out.comparisons) {
    const ParameterEstimate* const found = out.find(comparison.identified.parameter);
    if (found != nullptr) comparison.identified.identifiable = found->identifiable;
  }
  enforce_inertia_triangle_inequality(out);
  for (std::size_t a = 0; a < written.size(); ++a) {
    for (std::size_t b = a + 1; b < written.size(); ++b) {
      const double scale =
          std::sqrt(values.covariance(written[a], written[a]) * values.covariance(written[b], written[b]));
      const double correlation = scale > 0.0 ? values.covariance(written[a], written[b]) / scale : 0.0;
      if (std::abs(correlation) < 0.05) continue;
      out.uncertainty.correlations.push_back({out.estimates[static_cast<std::size_t>(written[a])].parameter,
                                              out.estimates[static_cast<std::size_t>(written[b])].parameter,
                                              std::clamp(correlation, -1.0, 1.0)});
    }
  }
}

void reject_negative_gains(const int (&gain)[3], const plant::Vehicle& base, const EstimatedParameters& fit) {
  for (int axis = 0; axis < 3; ++axis) {
    if (gain[axis] == kAbsent) continue;
    if (fit.parameters[gain[axis]] > -kNegativeErrors * fit.standard_error(gain[axis])) continue;
    throw BadData("the vehicle turns about " + std::string(kAxisNames[axis]) +
                  " opposite to the moments of the rotors of " + base.name +
                  "; are the motors in its order, and are the body axes forward-right-down or "
                  "forward-left-up as given?");
  }
}

void warn_of_fit(FlightIdentification& out, const std::vector<FlightParameter>& parameters,
                 const SeriesFit& fit) {
  if (!fit.converged) out.warnings.emplace_back("the fit did not converge; do not trust its numbers");
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = fit.parameters[static_cast<Index>(i)];
    if (!at_bound(parameters[i], value)) continue;
    out.warnings.push_back(parameters[i].name + " is " + format_number(value) + " " + parameters[i].unit +
                           ", a bound of the search; the model does not describe this flight");
  }
}

void warn_of_windows(FlightIdentification& out, const std::vector<FlightLog>& logs) {
  for (std::size_t f = 0; f < out.windows.size(); ++f) {
    for (const std::string& sentence : out.windows[f].left_out)
      out.warnings.push_back(logs[f].name + ": " + sentence);
    if (out.windows[f].ends_in_impact)
      out.warnings.push_back(logs[f].name + ": an impact of more than " + format_number(kImpact) +
                             " m/s^2 ends the flight; later rows are not used");
  }
}

}  // namespace swiftlet::identification

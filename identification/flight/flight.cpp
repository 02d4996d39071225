#include "swiftlet/identification/flight/flight.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <utility>

#include "swiftlet/identification/flight/command_flight.hpp"
#include "swiftlet/identification/flight/flight_prediction.hpp"
#include "swiftlet/identification/flight/flight_results.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kWellStampedS = 0.002;  // s, smaller delays of the poses are not reported
// s, standard error of tau_m by the model alone: stamps wait for interrupts, and the supply sags between two of its samples.
constexpr double kTimingErrorS = 1e-5;

struct Fitted {
  std::unique_ptr<FlightModel> model;
  SeriesFit fit;
};

std::vector<Derived> derived(const FlightModel& model, Known known) {
  const FlightLayout& l = model.layout();
  const plant::Vehicle& base = model.base();
  const bool mass_known = known == Known::kMass;
  const double k = base.rotor.thrust;
  const auto at = [](int index) { return [index](const VectorXd& x) { return x[index]; }; };
  std::vector<Derived> out;
  out.push_back({"motor.time_constant", "tau_m", "s", at(l.lag)});
  if (l.motor_delay != kAbsent) {
    out.push_back({"delay.rotor_speed", "T_m", "s", at(l.motor_delay)});
    out.push_back({"speed_scale", "s_Omega", "1", at(l.speed_scale)});
  } else {
    out.push_back({"delay.force", "T_f", "s", at(l.force_delay)});
    out.push_back({"delay.rates", "T_w", "s", at(l.rate_delay)});
  }
  out.push_back({"thrust_factor_over_mass", "k_T/m", "N*s^2/kg",
                 [&l, &base, k](const VectorXd& x) { return x[l.thrust] * k / base.mass_kg; }});
  for (int axis = 0; axis < 3; ++axis) {
    const double over_inertia = k * plant::mean_lever(base, axis) / base.inertia(axis, axis);
    const int gain = l.gain[axis];
    out.push_back({std::string("rotor_to_rate.") + axis_name(axis),
                   axis == 2   ? "k_Q/J_zz"
                   : axis == 1 ? "k_T d/J_yy"
                               : "k_T d/J_xx",
                   "1", [gain, over_inertia](const VectorXd& x) { return x[gain] * over_inertia; }});
  }
  if (mass_known) {
    out.push_back(
        {"rotor.thrust_factor", "k_T", "N*s^2", [&l, k](const VectorXd& x) { return x[l.thrust] * k; }});
  } else {
    out.push_back({"mass", "m", "kg", [&l, &base](const VectorXd& x) { return base.mass_kg / x[l.thrust]; }});
  }
  const char* const symbols[3] = {"J_xx", "J_yy", "J_zz"};
  for (int axis = 0; axis < 3; ++axis) {
    // With the thrust known and the mass identified, J_xx and J_yy do not depend on the mass.
    out.push_back({plant::kInertiaKeys[static_cast<std::size_t>(axis)], symbols[axis], "kg*m^2",
                   [&model, &l, axis, mass_known](const VectorXd& x) {
                     const double of_mass = model.inertia(x)[axis];
                     return mass_known || axis == 2 ? of_mass : of_mass / x[l.thrust];
                   }});
  }
  out.push_back({"linear_drag", "c", "N*s/m", [&l, &base, mass_known](const VectorXd& x) {
                   return x[l.drag] * base.mass_kg / (mass_known ? 1.0 : x[l.thrust]);
                 }});
  out.push_back({"thrust_centre.x", "r_x", "m", at(l.trim[1])});
  out.push_back({"thrust_centre.y", "r_y", "m", at(l.trim[0])});
  for (std::size_t log = 0; log < l.offset.size(); ++log) {
    const std::string of_log = l.offset.size() > 1 ? "[" + std::to_string(log) + "]" : "";
    for (int axis = 0; axis < 3; ++axis) {
      out.push_back({"accelerometer_offset" + of_log + "." + "xyz"[axis], std::string("b_") + "xyz"[axis],
                     "m/s^2", at(l.offset[log] + axis)});
    }
  }
  return out;
}

Fitted fit(std::vector<FlightSeries> flights, const plant::Vehicle& base, const FlightOptions& options) {
  Fitted out;
  out.model = std::make_unique<FlightModel>(std::move(flights), base);
  out.fit = fit_series(out.model->problem([&] {
    if (options.progress) options.progress("fitting");
  }));
  const int lag = out.model->layout().lag;
  out.fit.covariance(lag, lag) += kTimingErrorS * kTimingErrorS;
  return out;
}

// Standard deviation.
double spread(const std::vector<double>& values) {
  double mean = 0.0;
  for (const double value : values) mean += value / static_cast<double>(values.size());
  double square = 0.0;
  for (const double value : values)
    square += (value - mean) * (value - mean) / static_cast<double>(values.size());
  return std::sqrt(square);
}

// Standard deviations over the estimation set.
struct Excitation {
  Vector3d acceleration = Vector3d::Zero();  // rad/s^2, by the rotors
  Vector3d coupling = Vector3d::Zero();      // rad/s^2, by the coupling of Eq. (6)
  double thrust = 0.0;                       // m/s^2, over mass
  double speed = 0.0;                        // m/s, horizontal
};

Excitation excitation(const FlightModel& model, const VectorXd& x) {
  std::vector<double> series[8];
  const Vector3d inertia = model.inertia(x);
  for (std::size_t f = 0; f < model.flights().size(); ++f) {
    const FlightSeries& flight = model.flights()[f];
    const FlightModel::Drive drive = model.drive(x, f, flight.estimation_set);
    for (std::size_t i = 0; i < flight.estimation_set.size(); ++i) {
      const Vector3d& rates = flight.log->body_rates_frd[flight.estimation_set.first + i];
      const Vector3d coupling = -rates.cross(inertia.cwiseProduct(rates)).cwiseQuotient(inertia);
      for (int axis = 0; axis < 3; ++axis) {
        series[axis].push_back(drive.acceleration[i][axis]);
        series[3 + axis].push_back(coupling[axis]);
      }
      series[6].push_back(drive.specific_force[i].z());
      series[7].push_back(flight.velocity_ned[flight.estimation_set.first + i].head<2>().norm());
    }
  }
  return {{spread(series[0]), spread(series[1]), spread(series[2])},
          {spread(series[3]), spread(series[4]), spread(series[5])},
          spread(series[6]),
          spread(series[7])};
}

// What to fly to identify the parameter.
std::string advice(const std::string& parameter, const Excitation& excited) {
  for (std::size_t axis = 0; axis < plant::kInertiaKeys.size(); ++axis) {
    if (parameter == plant::kInertiaKeys[axis])
      return std::string("angular acceleration about ") + axis_name(static_cast<int>(axis)) +
             " varies by only " + format_number(excited.acceleration[static_cast<Index>(axis)]) +
             " rad/s^2; " + excitation_advice(axis);
  }
  if (parameter == "linear_drag")
    return "the horizontal speed varies by only " + format_number(excited.speed) + " m/s; fly faster";
  if (parameter == "motor.time_constant")
    return "the commands change too slowly or too little; fly quick moves, also up and down";
  return "thrust over mass varies by only " + format_number(excited.thrust) +
         " m/s^2; climb and descend quickly";
}

std::array<RateExcitation, 3> rate_excitations(const FlightModel& model, const VectorXd& x) {
  const std::vector<PredictionError> errors = prediction_errors(model, x, Part::kEstimationSet);
  std::array<RateExcitation, 3> out;
  for (std::size_t axis = 0; axis < out.size(); ++axis)
    out[axis] = {errors[axis].quantity, errors[axis].persistence_half_second, errors[axis].one_step};
  return out;
}

void report_assumptions(FlightIdentification& out, const FlightModel& model, const SeriesFit& fit,
                        Known known) {
  const plant::Vehicle& base = model.base();
  const double s = fit.parameters[model.layout().thrust];
  out.findings.push_back(
      known == Known::kMass ? "a flight determines only thrust over mass: the mass is assumed to be " +
                                  format_number(base.mass_kg) + " kg; with the thrust factor of " +
                                  base.name + " it would be " + format_number(base.mass_kg / s) + " kg"
                            : "a flight determines only thrust over mass: the thrust factor is assumed to "
                              "be " +
                                  format_number(base.rotor.thrust) + " N*s^2; with the mass of " + base.name +
                                  " it would be " + format_number(s * base.rotor.thrust) + " N*s^2");
  out.findings.push_back(
      "a flight determines only torque over the moment of inertia about yaw: the torque factor is that of " +
      base.name + ", " + format_number(base.rotor.torque) + " N*m*s^2");
  if (model.source() == SpeedSource::kModelled)
    out.findings.push_back(
        "rotor speeds were not recorded: they are modelled with " + base.name +
        "'s ESC and motor at the recorded voltage, and the thrust factor absorbs their error");
}

void report_excitation(FlightIdentification& out, const Excitation& excited) {
  for (int axis = 0; axis < 3; ++axis) {
    if (excited.coupling[axis] > 0.1 * excited.acceleration[axis]) continue;
    out.unexcited.push_back("coupling about " + std::string(axis_name(axis)) + ", Eq. (6): varies by only " +
                            format_number(excited.coupling[axis]) + " rad/s^2, the rotors' part by " +
                            format_number(excited.acceleration[axis]) +
                            " rad/s^2; it does not determine the ratios of the moments of inertia");
  }
}

void report_poses(FlightIdentification& out, const std::vector<FlightSeries>& flights) {
  for (std::size_t f = 0; f < flights.size(); ++f) {
    const PoseTiming& timing = flights[f].pose_timing;
    const std::string of_log = flights.size() > 1 ? "[" + std::to_string(f) + "]" : "";
    const std::string name = timing.delay.parameter + of_log;
    if (!timing.identified) {
      out.unexcited.push_back(name + ": the poses are assumed to have no delay; tilt and turn quickly");
      continue;
    }
    out.estimates.push_back(timing.delay);
    out.estimates.back().parameter = name;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      out.estimates.push_back(timing.gyro_offset[axis]);
      out.estimates.back().parameter = "gyro_offset" + of_log + "." + "xyz"[axis];
    }
    if (std::abs(timing.delay.value) < kWellStampedS) continue;
    out.findings.push_back(flights[f].log->name + ": poses are stamped " +
                           format_number(1e3 * timing.delay.value) +
                           " ms late relative to the IMU; the delay is removed");
  }
}

}  // namespace

const ParameterEstimate* FlightIdentification::find(const std::string& parameter) const {
  const auto found = std::find_if(estimates.begin(), estimates.end(), [&](const ParameterEstimate& estimate) {
    return estimate.parameter == parameter;
  });
  return found == estimates.end() ? nullptr : &*found;
}

FlightIdentification identify_flight(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                     const FlightOptions& options) {
  std::vector<FlightSeries> flights = prepare_flights(logs, base, options.bounds);
  FlightIdentification out = start_identification(flights);
  if (out.source == SpeedSource::kCommanded) {
    identify_commands(out, flights, base, options);
    warn_of_windows(out, logs);
    return out;
  }
  const Fitted fitted = fit(std::move(flights), base, options);
  const FlightModel& model = *fitted.model;
  const SeriesFit& fit = fitted.fit;
  reject_negative_gains(model.layout().gain, base, fit);
  out.converged = fit.converged && within_bounds(model.layout().parameters, fit);
  const std::vector<Derived> quantities = derived(model, options.known);
  const DerivedValues values = evaluate(quantities, model.layout().parameters, fit);
  out.estimates = estimates_of(quantities, values, fit.degrees_of_freedom);
  const Excitation excited = excitation(model, fit.parameters);
  conclude_vehicle(out, values, base, not_identifiable_axes(rate_excitations(model, fit.parameters)),
                   [&](const std::string& parameter) { return advice(parameter, excited); });
  report_assumptions(out, model, fit, options.known);
  report_excitation(out, excited);
  report_poses(out, model.flights());
  warn_of_fit(out, model.layout().parameters, fit);
  warn_of_windows(out, logs);
  out.errors = prediction_errors(model, fit.parameters, Part::kValidationSet);
  out.trace = prediction_trace(model, fit.parameters);
  return out;
}

}  // namespace swiftlet::identification

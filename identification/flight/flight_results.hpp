// Results of a fit to flights: derived quantities with intervals, the identified vehicle, warnings.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_model.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"

namespace swiftlet::identification {

// A quantity that is a function of the fit's parameters.
struct Derived {
  std::string parameter;
  std::string symbol;
  std::string unit;
  std::function<double(const Eigen::VectorXd&)> of;
};

struct DerivedValues {
  Eigen::VectorXd values;
  Eigen::MatrixXd covariance;
};

// Values and covariance at the fit, by linear error propagation.
DerivedValues evaluate(const std::vector<Derived>& quantities, const std::vector<FlightParameter>& parameters,
                       const EstimatedParameters& fit);

std::vector<ParameterEstimate> estimates_of(const std::vector<Derived>& quantities,
                                            const DerivedValues& values, int degrees_of_freedom);

// A FlightIdentification with windows, source, estimation_set_s and validation_set_s set.
FlightIdentification start_identification(const std::vector<FlightSeries>& flights);

// Excitation of one body rate. Root mean squares, rad/s.
struct RateExcitation {
  std::string quantity;         // "p"
  double in_half_second = 0.0;  // change of the rate over 0.5 s
  double noise = 0.0;           // one-step prediction error
};

// Moments of inertia, by their keys, that are not identifiable for lack of excitation, each with the reason.
// excitations are of p, q, r. In calm flight the controller responds to gyro noise; the fit takes this
// response for the cause of the measured rates, and moments of inertia come out too small, by about one over
// the square of in_half_second / noise.
std::map<std::string, std::string> not_identifiable_axes(const std::array<RateExcitation, 3>& excitations);

// Advice on what to fly to excite an axis, 0 roll .. 2 yaw.
std::string excitation_advice(std::size_t axis);

// Whether all parameters of the fit are inside their bounds.
bool within_bounds(const std::vector<FlightParameter>& parameters, const EstimatedParameters& fit);

// Copies identified parameters from out.estimates to the vehicle if the fit converged within its bounds. A
// parameter is identified if its interval is narrow enough and it is not in not_identifiable. Adds a sentence
// with the reason to out.unexcited for each of the others. values belong to out.estimates; not_identifiable
// maps parameters to reasons. Throws BadData if a moment of inertia is not plausible.
void conclude_vehicle(FlightIdentification& out, const DerivedValues& values, const plant::Vehicle& base,
                      const std::map<std::string, std::string>& not_identifiable,
                      const std::function<std::string(const std::string& parameter)>& advice);

// Throws BadData if a gain is significantly negative. gain holds indices into the parameters of the fit.
void reject_negative_gains(const int (&gain)[3], const plant::Vehicle& base, const EstimatedParameters& fit);

// Warns if the fit did not converge or a parameter ended at a bound of the search.
void warn_of_fit(FlightIdentification& out, const std::vector<FlightParameter>& parameters,
                 const SeriesFit& fit);

// Warns of parts of the logs that are not used.
void warn_of_windows(FlightIdentification& out, const std::vector<FlightLog>& logs);

// "roll", "pitch", "yaw".
const char* axis_name(int axis);

}  // namespace swiftlet::identification

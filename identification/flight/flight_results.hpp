// What follows from a fit to flights: quantities with intervals, a vehicle file's numbers, warnings.
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

// A quantity that follows from the parameters of the fit.
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

DerivedValues evaluate(const std::vector<Derived>& quantities, const std::vector<FlightParameter>& parameters,
                       const EstimatedParameters& fit);

std::vector<ParameterEstimate> estimates_of(const std::vector<Derived>& quantities,
                                            const DerivedValues& values, int degrees_of_freedom);

// Windows, source and lengths of time.
FlightIdentification begun_with(const std::vector<FlightSeries>& flights);

// How much a rate changes, and by how much its next sample cannot be told: root mean squares, rad/s.
struct RateExcitation {
  std::string quantity;  // "p"
  double in_half_second = 0.0;
  double noise = 0.0;
};

// Moments of inertia, by their keys, about axes that move too little to tell them, with the reason. excitations
// are of p, q, r. The controller answers the gyro's noise, and what it answers would be taken for what its answer
// does: moments come out too small, by about one over the square of the ratio.
std::map<std::string, std::string> not_identifiable_axes(const std::array<RateExcitation, 3>& excitations);

// What to fly for an axis, 0 roll .. 2 yaw.
std::string moves_that_tell(std::size_t axis);

// Whether the search ended inside its bounds.
bool within_bounds(const std::vector<FlightParameter>& parameters, const EstimatedParameters& fit);

// Puts what out.estimates tell well enough into the vehicle, if the fit converged within its bounds, and says
// of the rest what would tell it. values are those of out.estimates; untold are parameters that are not to be
// believed whatever their intervals, with the reason. Throws BadData for what no body is.
void conclude_vehicle(FlightIdentification& out, const DerivedValues& values, const plant::Vehicle& base,
                      const std::map<std::string, std::string>& untold,
                      const std::function<std::string(const std::string& parameter)>& advice);

// Throws BadData where a gain, by its place among the parameters, is negative for certain.
void refuse_turned_gains(const int (&gain)[3], const plant::Vehicle& base, const EstimatedParameters& fit);

// Of fits that did not converge, or that ended where the search ends.
void warn_of_fit(FlightIdentification& out, const std::vector<FlightParameter>& parameters,
                 const SeriesFit& fit);

void warn_of_windows(FlightIdentification& out, const std::vector<FlightLog>& logs);

// "roll", "pitch", "yaw".
const char* axis_name(int axis);

}  // namespace swiftlet::identification

// How well a fitted model predicts flight that it was not fitted to.
#pragma once

#include <vector>

#include "identification/flight.hpp"

namespace swiftlet::identification {

std::vector<PredictionError> prediction_errors(const FlightModel& model, const Eigen::VectorXd& parameters);

PredictionTrace prediction_trace(const FlightModel& model, const Eigen::VectorXd& parameters);

}  // namespace swiftlet::identification

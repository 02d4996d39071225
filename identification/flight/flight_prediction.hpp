// How well a fitted model predicts flight by its commands.
#pragma once

#include <vector>

#include "swiftlet/identification/flight/flight.hpp"

namespace swiftlet::identification {

enum class Part { kFitted, kKept };

std::vector<PredictionError> prediction_errors(const FlightModel& model, const Eigen::VectorXd& parameters,
                                               Part part);

// Of the kept rows of the first flight.
PredictionTrace prediction_trace(const FlightModel& model, const Eigen::VectorXd& parameters);

}  // namespace swiftlet::identification

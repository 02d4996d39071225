// Prediction errors of a fitted model under the commands of a flight.
#pragma once

#include <vector>

#include "swiftlet/identification/flight/flight.hpp"

namespace swiftlet::identification {

constexpr double kAheadS = 0.5;  // of a prediction

enum class Part { kEstimationSet, kValidationSet };

std::vector<PredictionError> prediction_errors(const FlightModel& model, const Eigen::VectorXd& parameters,
                                               Part part);

// Predictions over the validation set of the first flight.
PredictionTrace prediction_trace(const FlightModel& model, const Eigen::VectorXd& parameters);

}  // namespace swiftlet::identification

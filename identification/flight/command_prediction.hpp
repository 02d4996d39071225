// Prediction errors of a CommandModel on the validation set.
#pragma once

#include <array>
#include <vector>

#include "swiftlet/identification/flight/command_model.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_results.hpp"

namespace swiftlet::identification {

struct CommandPredictions {
  std::vector<PredictionError> errors;        // of p, q, r, f_z; one step is a block
  std::array<RateExcitation, 3> excitations;  // of p, q, r on the estimation set
  // Weights of the forecast 0.5 s ahead, in the order of errors: of the change predicted by the commands, and
  // of the measured value at its start.
  std::vector<double> weight_of_commands;
  std::vector<double> weight_of_start;
  std::vector<HorizonError> horizons;
  PredictionTrace trace;
};

CommandPredictions command_predictions(const CommandModel& model, const Eigen::VectorXd& parameters);

}  // namespace swiftlet::identification

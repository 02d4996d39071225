// How well a model of commands alone predicts flight that it was not fitted to.
#pragma once

#include <array>
#include <vector>

#include "swiftlet/identification/flight/command_model.hpp"
#include "swiftlet/identification/flight/flight.hpp"
#include "swiftlet/identification/flight/flight_results.hpp"

namespace swiftlet::identification {

struct CommandPredictions {
  std::vector<PredictionError> errors;        // p, q, r, f_z; one step is a block
  std::array<RateExcitation, 3> excitations;  // of p, q, r on the fitted rows
  // Of the forecast half a second ahead, in the same order: what it takes of the change by the commands and
  // of the deviation from the mean at its start.
  std::vector<double> weight_of_commands;
  std::vector<double> weight_of_start;
  std::vector<HorizonError> horizons;
  PredictionTrace trace;
};

CommandPredictions command_predictions(const CommandModel& model, const Eigen::VectorXd& parameters);

}  // namespace swiftlet::identification

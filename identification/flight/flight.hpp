// Identifies the parameters of a vehicle from logs of its flights.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_model.hpp"
#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {

// A flight determines only thrust over mass: one of the two has to be known, and is the base vehicle's.
enum class Known { kMass, kThrust };

struct FlightOptions {
  Known known = Known::kMass;
  FlightBounds bounds;
  std::function<void(const std::string& what)> progress;  // called regularly during the fit; may be empty
};

// Root mean square prediction errors of one quantity over the validation set. persistence_* are the errors of
// the persistence baseline: rates keep their last value; the specific force is its mean or, for
// SpeedSource::kCommanded, also keeps its last value.
struct PredictionError {
  std::string quantity;  // "p"
  std::string unit;
  double one_step = 0.0;
  double persistence_one_step = 0.0;
  // 0.5 s ahead. Rates are integrated from the measured value under the commands alone. The specific force is
  // no state: its error equals one_step. For SpeedSource::kCommanded the forecast is a weighted sum of the
  // prediction by the commands, the measured value at its start and the mean, with the weights that are best
  // on the estimation set (Bates, Granger 1969).
  double half_second = 0.0;
  double persistence_half_second = 0.0;
};

// Root mean square errors of the prediction over one horizon, from the measured value, under the commands
// alone.
struct HorizonError {
  std::string quantity;
  std::string unit;
  double horizon_s = 0.0;
  double by_commands = 0.0;
  double persistence = 0.0;  // error of the persistence baseline
};

// Compares an estimate with the value in the base vehicle's file.
struct FileComparison {
  ParameterEstimate identified;
  double file = 0.0;  // value of the file, in the unit of the estimate

  double ratio() const { return identified.value / file; }
};

// For a figure: thrust of all rotors over mass, as a function of a command that is equal for all rotors.
struct CommandedThrust {
  std::vector<double> command;     // 0 .. 1, increasing
  std::vector<double> over_mass;   // m/s^2
  std::vector<double> half_width;  // m/s^2, of the 95 % intervals
};

// For figures: measured values and predictions by the commands alone, over the validation set of the first
// log.
struct PredictionTrace {
  double restart_s = 0.5;                       // s, predictions restart from the measured value this often
  std::vector<double> time_s;                   // from the start of the validation set
  std::array<std::vector<double>, 4> measured;  // p, q, r in rad/s, f_z in m/s^2
  std::array<std::vector<double>, 4> predicted;
};

struct FlightIdentification {
  SpeedSource source = SpeedSource::kMeasured;
  std::vector<FlightWindow> windows;  // of each log
  double estimation_set_s = 0.0;      // s, estimation sets of all logs
  double validation_set_s = 0.0;      // s, validation sets of all logs
  bool converged = false;             // the fit converged inside the bounds of the search

  std::vector<ParameterEstimate> estimates;  // `parameter` is the key in the vehicle file, if it has one
  std::vector<std::string> unexcited;        // sentences: parameters that are not identifiable, and why
  std::vector<std::string> findings;         // sentences
  std::vector<std::string> warnings;         // sentences
  double step_s = 0.0;                       // s, length of a one-step prediction; 0 if it is one sample
  std::vector<PredictionError> errors;
  PredictionTrace trace;

  // For SpeedSource::kCommanded only:
  std::vector<ParameterEstimate> lags;  // tau_m fitted to each response alone; `parameter` names the response
  std::vector<FileComparison> comparisons;
  std::vector<HorizonError> horizons;
  CommandedThrust thrust;

  plant::Vehicle vehicle;                      // base vehicle with the identified parameters
  plant::VehicleUncertainty uncertainty;       // of the identified parameters
  std::map<std::string, std::string> sources;  // of the identified parameters, by key of the file

  const ParameterEstimate* find(const std::string& parameter) const;  // null if not estimated
};

// Identifies a vehicle from logs of its flights. All logs must have the same SpeedSource. For kCommanded see
// command_flight.hpp. Throws BadData.
FlightIdentification identify_flight(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                     const FlightOptions& options);

}  // namespace swiftlet::identification

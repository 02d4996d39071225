// From logs of flights to the parameters of the vehicle that flew.
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
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/vehicle_uncertainty.hpp"
#include "swiftlet/recording/flight_log.hpp"

namespace swiftlet::identification {

// A flight tells thrust over mass: one of them has to be known.
enum class Known { kMass, kThrust };

struct FlightOptions {
  Known known = Known::kMass;
  FlightBounds bounds;
  std::function<void(const std::string& what)> progress;  // now and then; may be empty
};

// Of a quantity that was predicted and measured: root mean squares over the kept rows. idle is the prediction
// that nothing changes: rates stay as they are, the specific force is its mean, or stays too where the
// commands are all that was recorded.
struct PredictionError {
  std::string quantity;  // "p"
  std::string unit;
  double one_step = 0.0;
  double idle_one_step = 0.0;
  // Of rates: from the measured ones on, by the commands alone. Of forces, which are no state: as one_step.
  // Where the commands are all that was recorded: what was best half a second ahead on the fitted rows, a sum
  // of that, of the measured value at the start and of the mean (Bates, Granger 1969).
  double half_second = 0.0;
  double idle_half_second = 0.0;
};

// By the commands alone, from the measured value on, over some time; beside that nothing changes.
struct HorizonError {
  std::string quantity;
  std::string unit;
  double horizon_s = 0.0;
  double by_commands = 0.0;  // root mean squares
  double persistence = 0.0;
};

// A number of the base vehicle's file beside what the logs tell of it.
struct FileComparison {
  ParameterEstimate identified;
  double file = 0.0;

  double ratio() const { return identified.value / file; }
};

// For a figure: thrust of all rotors over mass by a command that they share.
struct CommandedThrust {
  std::vector<double> command;     // 0 .. 1, rising
  std::vector<double> over_mass;   // m/s^2
  std::vector<double> half_width;  // of 95 % intervals
};

// For figures: what was measured of the kept rows of the first log, and what was predicted of it by the
// commands alone.
struct PredictionTrace {
  double restart_s = 0.5;                       // after which a prediction begins anew from what was measured
  std::vector<double> time_s;                   // from the beginning of the kept rows
  std::array<std::vector<double>, 4> measured;  // p, q, r in rad/s, f_z in m/s^2
  std::array<std::vector<double>, 4> predicted;
};

struct FlightIdentification {
  SpeedSource source = SpeedSource::kMeasured;
  std::vector<FlightWindow> windows;  // of each log
  double fitted_s = 0.0;
  double kept_s = 0.0;
  bool converged = false;  // inside the bounds of the search

  std::vector<ParameterEstimate>
      estimates;  // all that the logs tell; `parameter` is the vehicle file's key where it has one
  std::vector<std::string> unexcited;  // what they do not, and why; sentences
  std::vector<std::string> findings;
  std::vector<std::string> warnings;
  double step_s = 0.0;  // of the predictions one step ahead
  std::vector<PredictionError> errors;
  PredictionTrace trace;

  // Where the commands are all that was recorded:
  std::vector<ParameterEstimate>
      lags;  // tau_m as each response alone tells it; `parameter` names the response
  std::vector<FileComparison> comparisons;
  std::vector<HorizonError> horizons;
  CommandedThrust thrust;

  plant::Vehicle vehicle;  // the base with all that was told well enough
  plant::VehicleUncertainty uncertainty;
  std::map<std::string, std::string> sources;

  const ParameterEstimate* find(const std::string& parameter) const;  // null if it was not estimated
};

// Logs of one vehicle, of one source of speeds; by commands alone, see command_flight.hpp. Throws BadData.
FlightIdentification identify_flight(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                     const FlightOptions& options);

}  // namespace swiftlet::identification

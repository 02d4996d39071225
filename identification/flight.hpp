// From logs of flights to the parameters of the vehicle that flew.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "identification/estimate.hpp"
#include "identification/flight_log.hpp"
#include "identification/flight_model.hpp"
#include "identification/flight_window.hpp"
#include "plant/model/vehicle.hpp"
#include "plant/model/vehicle_uncertainty.hpp"

namespace swiftlet::identification {

// A flight tells thrust over mass: one of them has to be known.
enum class Known { kMass, kThrust };

struct FlightOptions {
  Known known = Known::kMass;
  FlightBounds bounds;
  std::function<void(const std::string& what)> progress;  // now and then; may be empty
};

// Of a quantity that was predicted and measured: root mean squares over the kept rows. idle is the prediction
// that nothing changes: rates stay as they are, the specific force is its mean.
struct PredictionError {
  std::string quantity;  // "p"
  std::string unit;
  double one_step = 0.0;
  double idle_one_step = 0.0;
  // Of rates: from the measured ones on, by the commands alone. Of forces, which are no state: as one_step.
  double half_second = 0.0;
  double idle_half_second = 0.0;
};

// For figures: what was measured of the kept rows of the first log, and what was predicted of it half a
// second ahead.
struct PredictionTrace {
  std::vector<double> time_s;       // from the beginning of the kept rows
  std::vector<double> measured[4];  // p, q, r in rad/s, f_z in m/s^2
  std::vector<double> predicted[4];
};

struct FlightIdentification {
  SpeedSource source = SpeedSource::kMeasured;
  std::vector<FlightWindow> windows;  // of each log
  double fitted_s = 0.0;
  double kept_s = 0.0;
  bool converged = false;

  std::vector<Estimate>
      estimates;  // all that the logs tell; `parameter` is the vehicle file's key where it has one
  std::vector<std::string> unexcited;  // what they do not, and why; sentences
  std::vector<std::string> findings;
  std::vector<std::string> warnings;
  std::vector<PredictionError> errors;
  PredictionTrace trace;

  plant::Vehicle vehicle;  // the base with all that was told well enough
  plant::VehicleUncertainty uncertainty;
  std::map<std::string, std::string> sources;

  const Estimate* find(const std::string& parameter) const;  // null if it was not estimated
};

// Logs of one vehicle, of one source of speeds. Throws BadData.
FlightIdentification identify_flight(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                     const FlightOptions& options);

}  // namespace swiftlet::identification

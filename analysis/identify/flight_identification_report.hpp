// Formats the result of an identification from flights: as a table, as JSON, as an HTML page with figures.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/analysis/pages/page.hpp"
#include "swiftlet/identification/flight/flight.hpp"

namespace swiftlet::analysis {

struct FlightIdentificationReport {
  std::vector<std::string> logs;         // file names
  std::vector<std::string> assumptions;  // sentences
  std::string base_vehicle;              // name or path, as given
  identification::FlightIdentification found;
};

// A row for each parameter, the prediction errors, then parameters that are not identifiable, findings and
// warnings. Ends in a newline.
std::string flight_identification_table(const FlightIdentificationReport& report);

// Keys: logs: [{file, from_row, to_row}], source, estimation_set_s, validation_set_s, parameters:
// [{parameter, symbol, value, standard_error, interval_95, unit}], prediction: [{quantity, unit, one_step,
// persistence_one_step, half_second, persistence_half_second}], assumptions, unexcited, findings, warnings,
// vehicle, base_vehicle. For SpeedSource::kCommanded also lags: [{response, value, interval_95, unit}],
// beside_file: [{parameter, value, interval_95, file, ratio, unit}], step_s, horizons: [{quantity, unit,
// horizon_s, by_commands, persistence}], thrust_per_mass: {command, value, half_width_95}. One line without a
// newline.
std::string flight_identification_json(const FlightIdentificationReport& report);

// The same, and figures of predictions and measurements.
pages::Page flight_identification_page(const FlightIdentificationReport& report);

}  // namespace swiftlet::analysis

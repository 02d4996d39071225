// What an identification from flights gave: as a table for a terminal, as JSON, as a page with figures.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/identification/flight/flight.hpp"

namespace swiftlet::ground {

struct FlightIdentificationReport {
  std::vector<std::string> logs;  // files
  std::vector<std::string> assumptions;
  std::string base_vehicle;  // as named
  identification::FlightIdentification found;
};

// A row for each parameter, the prediction errors, then what was not excited, findings and warnings; ends in
// a newline.
std::string flight_identification_table(const FlightIdentificationReport& report);

// logs: [{file, from_row, to_row}], source, estimation_set_s, validation_set_s, parameters: [{parameter,
// symbol, value, standard_error, interval_95, unit}], prediction: [{quantity, unit, one_step,
// persistence_one_step, half_second, persistence_half_second}], unexcited, findings, warnings, vehicle; of
// logs of commands and IMU alone also lags: [{response, value, interval_95, unit}], beside_file: [{parameter,
// value, interval_95, file, ratio, unit}], step_s, horizons: [{quantity, unit, horizon_s, by_commands,
// idle}], thrust_per_mass: {command, value, half_width_95}. One line, without a newline at its end.
std::string flight_identification_json(const FlightIdentificationReport& report);

// One HTML file that needs nothing else: these, and the predictions beside what was measured.
std::string flight_identification_html(const FlightIdentificationReport& report);

}  // namespace swiftlet::ground

// What an identification gave: as a page with figures, as a table for a terminal, as JSON.
#pragma once

#include <string>

#include "swiftlet/ground/identify/bench_files.hpp"
#include "swiftlet/identification/bench/bench.hpp"

namespace swiftlet::ground {

struct IdentificationReport {
  std::string bench_folder;
  std::string base_vehicle;  // as named
  plant::Vehicle base;
  Bench bench;
  identification::BenchIdentification found;
};

// One HTML file that needs nothing else: the paper's Figs. 2, 3, 4, 6 and 7 from these data, fits, intervals,
// residuals, outliers by line, findings and warnings.
std::string identification_html(const IdentificationReport& report);

// A row for each parameter, then outliers and warnings; ends in a newline.
std::string identification_table(const IdentificationReport& report);

// parameters: [{parameter, symbol, value, standard_error, interval_95, unit, experiment}], experiments:
// [{name, rows, r_squared, residual_sd, residual_unit, outlier_lines, findings, warnings}], warnings,
// vehicle. One line, without a newline at its end.
std::string identification_json(const IdentificationReport& report);

}  // namespace swiftlet::ground

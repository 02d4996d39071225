// Formats the result of an identification from bench data: as an HTML page with figures, as a table, as JSON.
#pragma once

#include <string>

#include "swiftlet/analysis/identify/bench_files.hpp"
#include "swiftlet/analysis/pages/page.hpp"
#include "swiftlet/identification/bench/bench.hpp"

namespace swiftlet::analysis {

struct IdentificationReport {
  std::string bench_folder;
  std::string base_vehicle;  // name or path, as given
  plant::Vehicle base;
  Bench bench;
  identification::BenchIdentification found;
};

// The paper's Figs. 2, 3, 4, 6 and 7 from these data, fits, intervals,
// residuals, outliers by line, findings and warnings.
pages::Page identification_page(const IdentificationReport& report);

// A row for each parameter, then outliers, findings and warnings. Ends in a newline.
std::string identification_table(const IdentificationReport& report);

// Keys: parameters: [{parameter, symbol, value, standard_error, interval_95, unit, experiment}], experiments:
// [{name, title, rows, r_squared, residual_sd, residual_unit, outlier_lines, findings, warnings}], warnings,
// vehicle, base_vehicle. One line without a newline.
std::string identification_json(const IdentificationReport& report);

}  // namespace swiftlet::analysis

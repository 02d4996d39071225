// Common parts of the reports of identifications.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "swiftlet/analysis/pages/page.hpp"
#include "swiftlet/identification/fitting/estimate.hpp"

namespace swiftlet::analysis {

// A unit, "V*s^2/rad^2", with superscript 2 and centred dots, UTF-8.
std::string written_unit(const std::string& unit);

// The same for a cell of a table: empty for the unit 1.
std::string unit_cell(const std::string& unit);

// The precision of these reports: the half width of an interval has two digits, its value ends with the last of them; what has no
// interval has three digits.
std::string three_digits(double value);
struct EstimateText {
  std::string value;
  std::string half_width;
};
EstimateText text_of(double value, double half_width);

// Dashes for one that is not identifiable.
EstimateText text_of(const identification::ParameterEstimate& estimate);

// As the columns "value" and "+- (95 %)" of a table in a terminal.
std::string table_cells(const identification::ParameterEstimate& estimate);

// Value and interval are null if it is not identifiable. Keys: parameter, symbol, value, standard_error, interval_95, unit.
nlohmann::ordered_json json_of(const identification::ParameterEstimate& estimate);

// Adds a table with a row for each estimate.
void add_estimates(pages::Page& page, const std::vector<identification::ParameterEstimate>& estimates);

}  // namespace swiftlet::analysis

#include "swiftlet/analysis/identify/report_page.hpp"

#include <cmath>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace swiftlet::analysis {

std::string written_unit(const std::string& unit) {
  using boost::algorithm::replace_all_copy;
  return replace_all_copy(replace_all_copy(unit, "^2", "\u00b2"), "*", "\u00b7");
}

std::string unit_cell(const std::string& unit) { return unit == "1" ? "" : written_unit(unit); }

nlohmann::ordered_json json_of(const identification::ParameterEstimate& estimate) {
  return {{"parameter", estimate.parameter},
          {"symbol", estimate.symbol},
          {"value", estimate.value},
          {"standard_error", estimate.standard_error},
          {"interval_95", {estimate.low(), estimate.high()}},
          {"unit", estimate.unit}};
}

void add_estimates(pages::Page& page, const std::vector<identification::ParameterEstimate>& estimates) {
  std::vector<pages::Row> rows;
  for (const identification::ParameterEstimate& e : estimates) {
    const double percent = e.value != 0.0 ? 100.0 * e.half_width / std::abs(e.value) : 0.0;
    rows.push_back({e.parameter, e.symbol, fmt::format("{:.5g} \u00b1 {:.2g}", e.value, e.half_width),
                    unit_cell(e.unit), fmt::format("\u00b1 {:.2g} %", percent)});
  }
  page.table({"parameter", "", "estimate, 95 % interval", "unit", "interval"}, rows);
}

}  // namespace swiftlet::analysis

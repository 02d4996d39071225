#include "swiftlet/analysis/identify/report_page.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace swiftlet::analysis {

std::string written_unit(const std::string& unit) {
  using boost::algorithm::replace_all_copy;
  return replace_all_copy(replace_all_copy(unit, "^2", "\u00b2"), "*", "\u00b7");
}

std::string unit_cell(const std::string& unit) { return unit == "1" ? "" : written_unit(unit); }

namespace {

// Also those that are 0 at the end.
std::string with_digits(double value, int digits) {
  char number[64];
  std::snprintf(number, sizeof number, "%#.*g", digits, value);  // fmt's differs for integers
  std::string text = number;
  const std::size_t point = text.find('.');
  if (point + 1 == text.size() || text[point + 1] == 'e') text.erase(point, 1);
  return text;
}

}  // namespace

std::string three_digits(double value) { return with_digits(value, 3); }

EstimateText text_of(double value, double half_width) {
  const double size = std::abs(value);
  if (!(half_width > 0.0) || !std::isfinite(half_width) || !(size > 0.0))
    return {fmt::format("{:.5g}", value), fmt::format("{:.2g}", half_width)};
  const double digits = 2.0 + std::floor(std::log10(size)) - std::floor(std::log10(half_width));
  return {with_digits(value, static_cast<int>(std::clamp(digits, 1.0, 12.0))), with_digits(half_width, 2)};
}

EstimateText text_of(const identification::ParameterEstimate& estimate) {
  if (!estimate.identifiable) return {"-", "-"};
  return text_of(estimate.value, estimate.half_width);
}

std::string table_cells(const identification::ParameterEstimate& estimate) {
  const EstimateText text = text_of(estimate);
  return fmt::format("{:>12}  {:<10}", text.value, text.half_width);
}

nlohmann::ordered_json json_of(const identification::ParameterEstimate& estimate) {
  nlohmann::ordered_json json = {{"parameter", estimate.parameter},
                                 {"symbol", estimate.symbol},
                                 {"value", estimate.value},
                                 {"standard_error", estimate.standard_error},
                                 {"interval_95", {estimate.low(), estimate.high()}},
                                 {"unit", estimate.unit}};
  if (!estimate.identifiable) json["value"] = json["standard_error"] = json["interval_95"] = nullptr;
  return json;
}

void add_estimates(pages::Page& page, const std::vector<identification::ParameterEstimate>& estimates) {
  std::vector<pages::Row> rows;
  for (const identification::ParameterEstimate& e : estimates) {
    const double percent = e.value != 0.0 ? 100.0 * e.half_width / std::abs(e.value) : 0.0;
    const EstimateText text = text_of(e);
    if (e.identifiable) {
      rows.push_back({e.parameter, e.symbol, text.value + " \u00b1 " + text.half_width, unit_cell(e.unit),
                      fmt::format("\u00b1 {:.2g} %", percent)});
    } else {
      rows.push_back({e.parameter, e.symbol, "not identifiable", unit_cell(e.unit), ""});
    }
  }
  page.table({"parameter", "", "estimate, 95 % interval", "unit", "interval"}, rows);
}

}  // namespace swiftlet::analysis

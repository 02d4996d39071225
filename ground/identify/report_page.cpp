#include "swiftlet/ground/identify/report_page.hpp"

#include <cmath>
#include <cstdio>

#include <fmt/core.h>

#include "swiftlet/io/atomic_write.hpp"

namespace swiftlet::ground {

std::string written_unit(const std::string& unit) {
  std::string out;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    if (unit.compare(i, 2, "^2") == 0) {
      out += "\u00b2";
      ++i;
    } else if (unit[i] == '*') {
      out += "\u00b7";
    } else {
      out += unit[i];
    }
  }
  return out;
}

std::string unit_cell(const std::string& unit) { return unit == "1" ? "" : written_unit(unit); }

void add_estimates(plot::Page& page, const std::vector<identification::ParameterEstimate>& estimates) {
  std::vector<plot::Page::Row> rows;
  for (const identification::ParameterEstimate& e : estimates) {
    const double percent = e.value != 0.0 ? 100.0 * e.half_width / std::abs(e.value) : 0.0;
    rows.push_back({e.parameter, e.symbol, fmt::format("{:.5g} \u00b1 {:.2g}", e.value, e.half_width),
                    unit_cell(e.unit), fmt::format("\u00b1 {:.2g} %", percent)});
  }
  page.table({"parameter", "", "estimate, 95 % interval", "unit", "interval"}, rows);
}

void write_page(const plot::Page& page, const std::string& file) {
  const plot::Page::Html html = page.html();
  write_whole_file(file, html.text);
  if (!html.fault.empty()) std::fprintf(stderr, "swiftlet: %s: %s\n", file.c_str(), html.fault.c_str());
}

}  // namespace swiftlet::ground

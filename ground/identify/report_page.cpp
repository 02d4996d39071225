#include "swiftlet/ground/identify/report_page.hpp"

#include <cmath>

#include <fmt/core.h>

#include "swiftlet/ground/identify/identification_figures.hpp"
#include "swiftlet/ground/report/svg_figure.hpp"

namespace swiftlet::ground {
namespace {

using identification::ParameterEstimate;

// "value +- half width".
std::string with_interval(const ParameterEstimate& estimate) {
  return fmt::format("{:.5g} \xc2\xb1 {:.2g}", estimate.value, estimate.half_width);
}

double share_percent(const ParameterEstimate& estimate) {
  return estimate.value != 0.0 ? 100.0 * estimate.half_width / std::abs(estimate.value) : 0.0;
}

constexpr const char* kStyle = R"(<style>
body { font: 15px/1.45 sans-serif; color: #1a1a1a; max-width: 1360px; margin: 24px auto; padding: 0 20px; }
h1 { font-size: 25px; margin-bottom: 4px; } h2 { font-size: 19px; margin: 34px 0 6px; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; margin: 8px 0; } th, td { padding: 3px 14px 3px 0; text-align: left; }
th { border-bottom: 1px solid #999; font-weight: 600; } td.n { font-variant-numeric: tabular-nums; white-space: nowrap; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(520px, 1fr)); gap: 14px 22px; align-items: end; }
figure { margin: 0; } figcaption { font-size: 13px; color: #444; padding-left: 48px; } svg { width: 100%; height: auto; display: block; }
.warning { background: #fff3cd; border-left: 4px solid #e0a800; padding: 4px 10px; margin: 5px 0; }
.finding { margin: 4px 0; } .quiet { color: #555; font-size: 14px; }
</style>
)";

}  // namespace

std::string page_head(const std::string& title) {
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>" + html_escaped(title) +
         "</title>\n" + kStyle + "</head><body>\n<h1>" + html_escaped(title) + "</h1>\n";
}

std::string html_unit(const std::string& unit) { return unit == "1" ? "" : html_escaped(written_unit(unit)); }

std::string estimates_html(const std::vector<ParameterEstimate>& estimates) {
  std::string out =
      "<table><tr><th>parameter</th><th></th><th>estimate, 95 % "
      "interval</th><th>unit</th><th>interval</th></tr>\n";
  for (const ParameterEstimate& estimate : estimates) {
    out += "<tr><td>" + html_escaped(estimate.parameter) + "</td><td>" + html_escaped(estimate.symbol) +
           "</td><td class=\"n\">" + with_interval(estimate) + "</td><td>" + html_unit(estimate.unit) +
           "</td><td class=\"n\">" + fmt::format("\xc2\xb1 {:.2g} %", share_percent(estimate)) +
           "</td></tr>\n";
  }
  return out + "</table>\n";
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/batch/batch_page.hpp"

#include <vector>

#include <fmt/core.h>

#include "swiftlet/analysis/pages/page.hpp"
#include "swiftlet/ground/batch/batch_plot.hpp"
#include "swiftlet/io/format.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kScattersOfPage = 6;
constexpr std::size_t kMostFailed = 100;
constexpr double kMmPerM = 1e3;

pages::Row row_of(const std::string& name, const math::Spread& spread, double factor) {
  pages::Row row = {name};
  for (const double value : {spread.min, spread.p5, spread.median, spread.p95, spread.max})
    row.push_back(fmt::format("{:.3g}", factor * value));
  return row;
}

void add_spreads(pages::Page& page, const BatchReport& report) {
  std::vector<pages::Row> rows = {row_of("error 3-D, RMS (mm)", report.rms_3d_m, kMmPerM),
                                  row_of("error 3-D, peak (mm)", report.peak_3d_m, kMmPerM)};
  for (std::size_t i = 0; i < kMarginNames.size(); ++i)
    rows.push_back(
        row_of(std::string("phase margin, ") + kMarginNames[i] + " (deg)", report.margins_deg[i], 1.0));
  page.table({"", "least", "5 %", "median", "95 %", "largest"}, rows);
}

void add_failed(pages::Page& page, const BatchReport& report) {
  std::vector<pages::Row> rows;
  for (const BatchRun& run : report.batch.runs) {
    if (run.completed || rows.size() == kMostFailed) continue;
    rows.push_back({std::to_string(run.seed), run.reason, report.repeat_command(run.seed)});
  }
  if (rows.empty()) return;
  page.heading("Failed runs");
  page.table({"seed", "reason", "repeat"}, rows);
}

}  // namespace

std::string batch_page(const BatchReport& report) {
  pages::Page page("Batch of " + report.mission);
  page.paragraph(
      fmt::format("{}, {} failed, of {} requested; vehicle {}, control {}, dispersion {}; seeds from {}",
                  io::counted(report.batch.runs.size(), "run"), report.batch.failed(), report.batch.requested,
                  report.vehicle, report.control, report.dispersion, report.first_seed),
      report.completed() ? "quiet" : "warning");
  add_spreads(page, report);
  if (report.rms_3d_m.count > 0) page.figures({batch_figure(report, kScattersOfPage)});
  add_failed(page, report);
  return page.html();
}

}  // namespace swiftlet::ground

#include "swiftlet/analysis/report/flight_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/analysis/plot/gnuplot.hpp"
#include "swiftlet/analysis/plot/path_figure.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/json_text.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::analysis {
namespace {

using record::ReferenceRow;
using record::TruthRow;

constexpr std::int64_t kDrawnPeriod_ns = 10'000'000;  // of the flown path
constexpr double kLeastSpan_m = 0.25;                 // of a position axis, so that noise does not fill it

plot::Figure flight_figure(const record::Flight& flight, const FlightReport& report, record::Window window) {
  using plot::Colour;
  using plot::Style;
  plot::Figure figure = plot::path_figure(
      report.mission + " - " + report.vehicle + ", " + report.control +
          fmt::format(": 3-D error RMS {:.1f} mm, peak {:.1f} mm over {:.0f} s", report.errors.rms_3d_m * 1e3,
                      report.errors.peak_3d_m * 1e3, window.duration_s()) +
          (report.completed ? "" : " - NOT completed"),
      {"north x (m)", "east y (m)", "down z (m)", "error, flown - reference (mm)"},
      std::max(report.duration_s, 1.0) + 0.5);
  for (plot::Panel& panel : figure.panels)
    panel.series = {{Style::kLine, Colour::kBlue, "", {}, 1.8}, {Style::kDashes, Colour::kInk, "", {}, 0.7}};
  figure.panels[0].series[0].label = "flown";
  figure.panels[0].series[1].label = "reference";
  for (std::size_t i = 0; i < 3; ++i) figure.panels[i].y.least_span = kLeastSpan_m;
  figure.panels[2].y.reversed = true;
  figure.panels[3].x.label = "time from the start of the mission (s)";
  std::vector<plot::Series>& errors_mm = figure.panels[3].series;
  errors_mm = {{Style::kLine, Colour::kOrange, "x", {}, 0.6},
               {Style::kLine, Colour::kGreen, "y", {}, 0.6},
               {Style::kLine, Colour::kPurple, "z", {}, 0.6},
               {Style::kLine, Colour::kInk, "3-D", {}, 1.0}};
  const auto add = [&](std::size_t series, double t_s, const std::array<double, 3>& ned) {
    for (std::size_t i = 0; i < 3; ++i) figure.panels[i].series[series].points.push_back({t_s, ned[i]});
    for (const std::size_t view : {plot::kFromAbove, plot::kInSpace})
      figure.panels[view].series[series].points.push_back({ned[1], ned[0], -ned[2]});
  };
  const auto time_s = [&](std::int64_t stamp_ns) { return math::seconds(stamp_ns - window.from_ns); };
  for (const record::FaultRow& fault : flight.faults) {
    if (flight.truth.empty() || fault.from_ns > flight.truth.back().stamp_ns) continue;
    const std::string kind = fault.text.substr(0, fault.text.find(','));
    for (std::size_t i = 0; i < 4; ++i)
      figure.panels[i].intervals.push_back({time_s(fault.from_ns), time_s(fault.to_ns), i == 3 ? kind : ""});
  }
  std::int64_t due_ns = 0;
  for (const TruthRow& truth : flight.truth) {
    if (truth.stamp_ns < due_ns) continue;
    due_ns = truth.stamp_ns + kDrawnPeriod_ns;
    add(0, time_s(truth.stamp_ns), truth.position_ned);
  }
  auto after = flight.truth.begin();
  for (const ReferenceRow& reference : flight.reference) {
    const double t_s = time_s(reference.stamp_ns);
    add(1, t_s, reference.position_ned);
    while (after != flight.truth.end() && after->stamp_ns < reference.stamp_ns) ++after;
    const auto truth = record::motion_at(flight.truth, after, reference.stamp_ns);
    if (!truth || t_s < 0.0 || t_s >= window.duration_s()) continue;
    const Eigen::Vector3d error_mm =
        1e3 * (Eigen::Vector3d(truth->position_ned.data()) - Eigen::Vector3d(reference.position_ned.data()));
    for (std::size_t i = 0; i < 3; ++i)
      errors_mm[i].points.push_back({t_s, error_mm[static_cast<Eigen::Index>(i)]});
    errors_mm[3].points.push_back({t_s, error_mm.norm()});
  }
  return figure;
}

}  // namespace

void write_report_json(const std::filesystem::path& file, const FlightReport& report) {
  io::write_atomically(file, io::json_text(to_json(report), 2) + "\n");
}

std::string draw_flight(const std::filesystem::path& folder, const record::Flight& flight,
                        const FlightReport& report, record::Window window) {
  return plot::draw_png_if_installed(flight_figure(flight, report, window), folder / "flight.png");
}

}  // namespace swiftlet::analysis

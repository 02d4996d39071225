#include "swiftlet/ground/batch/batch_plot.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/analysis/plot/gnuplot.hpp"
#include "swiftlet/io/format.hpp"

namespace swiftlet::ground {
namespace {

using plot::Colour;
using plot::Style;

constexpr std::size_t kScattersOfFigure = 3;  // side by side
constexpr std::size_t kFirstScatter = 2;      // its panel
constexpr double kLongTail = 4.0;  // maximum over median, above which the error axis is logarithmic

std::string headline(const BatchReport& report) {
  const std::size_t failed = report.batch.failed();
  return report.mission + " - " + report.vehicle + ", " + report.control + ", dispersion " +
         report.dispersion + ": " + io::counted(report.batch.runs.size(), "run") +
         fmt::format(", {} failed", failed) + (failed > 0 ? " (red)" : "");
}

// The share of the runs whose error is at or below a value, %.
plot::Series distribution(const Batch& batch, double BatchRun::*error_m, Colour colour, const char* label) {
  std::vector<double> errors_mm;
  for (const BatchRun& run : batch.runs)
    if (std::isfinite(run.*error_m)) errors_mm.push_back(1e3 * run.*error_m);
  std::sort(errors_mm.begin(), errors_mm.end());
  plot::Series out{Style::kSteps, colour, label, {{errors_mm.front(), 0.0}}, 1.3};
  for (std::size_t i = 0; i < errors_mm.size(); ++i)
    out.points.push_back(
        {errors_mm[i], 100.0 * static_cast<double>(i + 1) / static_cast<double>(errors_mm.size())});
  return out;
}

plot::Panel error_panel(const BatchReport& report) {
  constexpr double kTop = 102.0;
  const double tolerance_mm = 1e3 * report.tolerance_m;
  plot::Panel panel{"",
                    plot::Box{0.060, 0.470, 0.575, 0.915},
                    {"tracking error, 3-D (mm)"},
                    {"share of the runs at or below (%)", 0.0, kTop}};
  panel.x.logarithmic = true;
  panel.series = {
      distribution(report.batch, &BatchRun::rms_3d_m, Colour::kBlue, "RMS"),
      distribution(report.batch, &BatchRun::peak_3d_m, Colour::kOrange, "peak"),
      {Style::kDashes, Colour::kRed, "tolerance on the peak", {{tolerance_mm, 0.0}, {tolerance_mm, kTop}}}};
  return panel;
}

plot::Panel margin_panel(const Batch& batch) {
  constexpr double kHalfWidth = 0.36;
  plot::Panel panel{"", plot::Box{0.560, 0.975, 0.575, 0.915}, {"", 0.4, 6.6}, {"phase margin (deg)"}};
  panel.x.names.assign(kMarginNames.begin(), kMarginNames.end());
  plot::Series nominal{Style::kLine, Colour::kOrange, "nominal vehicle", {}, 1.3};
  for (std::size_t i = 0; i < kMarginNames.size(); ++i) {
    const double x = static_cast<double>(i + 1);
    plot::Series box{Style::kBoxes, Colour::kBlue, i == 0 ? "quartiles and 90 % of the runs" : "", {}};
    for (const BatchRun& run : batch.runs) {
      const double margin_deg = as_array(run.margins_deg)[i];
      if (std::isfinite(margin_deg)) box.points.push_back({x, margin_deg});
    }
    panel.series.push_back(box);
    const double designed_deg = as_array(batch.designed_deg)[i];
    nominal.points.insert(nominal.points.end(),
                          {{x - kHalfWidth, designed_deg}, {x + kHalfWidth, designed_deg}, plot::kGap});
  }
  panel.series.push_back(nominal);
  return panel;
}

std::string axis_label(const std::string& name) {
  const auto& known = simulation::parameters();
  const auto found = std::find_if(known.begin(), known.end(),
                                  [&](const simulation::Parameter& p) { return p.name == name; });
  if (found == known.end() || found->unit == "1") return name;
  return name + " (" + (found->unit.empty() ? "times nominal" : found->unit) + ")";
}

// The RMS error over a parameter.
plot::Panel scatter_panel(const BatchReport& report, const ParameterEffect& effect, plot::Box box) {
  const auto index = static_cast<std::size_t>(
      std::find(report.parameters.begin(), report.parameters.end(), effect.name) - report.parameters.begin());
  plot::Panel panel{
      fmt::format("rank correlation {:+.2f}, distance {:+.2f}", effect.of_value, effect.of_distance),
      box,
      {axis_label(effect.name)},
      {"tracking error, RMS (mm)"}};
  panel.y.logarithmic = report.rms_3d_m.max > kLongTail * report.rms_3d_m.median;
  if (!panel.y.logarithmic) panel.y.from = 0.0;
  panel.series = {{Style::kDots, Colour::kBlue}, {Style::kDots, Colour::kRed, "", {}, 1.5}};
  for (const BatchRun& run : report.batch.runs)
    panel.series[run.completed ? 0 : 1].points.push_back({run.values[index], 1e3 * run.rms_3d_m});
  return panel;
}

}  // namespace

plot::Figure batch_figure(const BatchReport& report, std::size_t scatters) {
  plot::Figure figure{headline(report), 1600, 1100, {error_panel(report), margin_panel(report.batch)}};
  for (std::size_t i = 0; i < std::min(scatters, report.effects.size()); ++i) {
    if (report.effects[i].strength() < 0.0) break;
    const double left = 0.060 + 0.3225 * static_cast<double>(i);
    figure.panels.push_back(scatter_panel(report, report.effects[i], {left, left + 0.260, 0.085, 0.445}));
  }
  return figure;
}

std::string draw_batch(const std::filesystem::path& folder, const BatchReport& report) {
  if (report.rms_3d_m.count == 0) return "no picture was drawn: no run has a tracking error";
  plot::Figure figure = batch_figure(report, kScattersOfFigure);
  for (std::size_t i = kFirstScatter + 1; i < figure.panels.size(); ++i)
    figure.panels[i].y.label.clear();  // beside it
  return plot::draw_png_if_installed(figure, folder / "batch.png");
}

}  // namespace swiftlet::ground

#include "swiftlet/analysis/tuning/tuning_figure.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/core.h>

#include "swiftlet/analysis/plot/gnuplot.hpp"
#include "swiftlet/analysis/tuning/tuning_table.hpp"

namespace swiftlet::analysis {
namespace {

using plot::Colour;
using plot::Style;

constexpr int kWidth = 1900;
constexpr int kHeight = 1900;
constexpr std::size_t kColumns = 3;  // roll, pitch, yaw above x, y, z
constexpr double kPhaseTop = -30.0;
constexpr double kPhaseBottom = -300.0;
constexpr double kMagnitude_db = 40.0;  // shown above and below 0
// The margins stand in the step panel, below the curves, which are near 1 there.
constexpr double kFirstLabel = 0.10;
constexpr double kLabelStep = 0.13;
constexpr std::array<Colour, 6> kColours = {Colour::kBlue,   Colour::kOrange, Colour::kGreen,
                                            Colour::kPurple, Colour::kTeal,   Colour::kBrown};

Colour colour_of(std::size_t settings) { return kColours[settings % kColours.size()]; }

// The panel of this row (0: step, 1: magnitude, 2: phase) of a loop.
plot::Box box_of(std::size_t loop, std::size_t row) {
  const double left = 0.045 + 0.325 * static_cast<double>(loop % kColumns);
  const double top_of_block = loop < kColumns ? 0.950 : 0.465;
  constexpr std::array<double, 3> kTop = {0.000, 0.175, 0.290};
  constexpr std::array<double, 3> kTall = {0.130, 0.110, 0.110};
  const double top = top_of_block - kTop[row];
  return {left, left + 0.275, top - kTall[row], top};
}

std::string margin_text(const LoopStudy& loop) {
  if (!loop.stable) return "unstable";
  const double gain_db = 20.0 * std::log10(loop.margins.gain_increase);
  return fmt::format("PM {:.0f} deg at {:.1f} rad/s, GM {}, DM {:.0f} ms", loop.margins.phase_deg,
                     loop.crossover, std::isfinite(gain_db) ? fmt::format("{:+.1f} dB", gain_db) : "any",
                     1e3 * loop.margins.delay_s);
}

plot::Panel step_panel(const TuningStudy& study, std::size_t loop) {
  const char* const name = control::kFlownLoopNames[loop];
  double end_s = 0.0;
  for (const SettingsStudy& settings : study.settings)
    end_s = std::max(end_s, settings.loops[loop].time_s.back());
  plot::Panel panel{
      "", box_of(loop, 0), {"time (s)", 0.0, end_s}, {fmt::format("{} after a unit step", name), -0.1}};
  panel.series.push_back({Style::kLine, Colour::kInk, "", {{0.0, 1.0}, {end_s, 1.0}}, 0.5});
  for (std::size_t i = 0; i < study.settings.size(); ++i) {
    const LoopStudy& one = study.settings[i].loops[loop];
    panel.series.push_back(
        {Style::kLine, colour_of(i), study.settings[i].name, plot::points(one.time_s, one.response)});
    const double height = kFirstLabel + kLabelStep * static_cast<double>(study.settings.size() - 1 - i);
    panel.labels.push_back({{end_s, height}, margin_text(one), colour_of(i), true});
  }
  return panel;
}

// A curve of the Bode diagram and, at the crossover, a line from the curve to `level`.
void add_curve(plot::Panel& panel, const LoopStudy& loop, const std::vector<double>& values, double level,
               Colour colour) {
  panel.series.push_back({Style::kLine, colour, "", plot::points(loop.omega, values)});
  if (!std::isfinite(loop.crossover)) return;
  const auto at = std::lower_bound(loop.omega.begin(), loop.omega.end(), loop.crossover);
  if (at == loop.omega.end()) return;
  const double value = values[static_cast<std::size_t>(at - loop.omega.begin())];
  panel.series.push_back({Style::kDashes, colour, "", {{loop.crossover, level}, {loop.crossover, value}}});
}

plot::Panel bode_panel(const TuningStudy& study, std::size_t loop, std::size_t row, const plot::Axis& y) {
  const std::vector<double>& omega = study.settings.front().loops[loop].omega;
  plot::Panel panel{
      "", box_of(loop, row), {row == 2 ? "frequency (rad/s)" : "", omega.front(), omega.back()}, y};
  panel.x.logarithmic = true;
  panel.x.numbered = row == 2;
  return panel;
}

void add_level(plot::Panel& panel, double level) {
  panel.series.push_back(
      {Style::kLine, Colour::kInk, "", {{*panel.x.from, level}, {*panel.x.to, level}}, 0.5});
}

plot::Panel magnitude_panel(const TuningStudy& study, std::size_t loop) {
  plot::Panel panel = bode_panel(study, loop, 1, {"open loop (dB)", -kMagnitude_db, kMagnitude_db});
  add_level(panel, 0.0);
  for (std::size_t i = 0; i < study.settings.size(); ++i) {
    const LoopStudy& one = study.settings[i].loops[loop];
    add_curve(panel, one, one.magnitude_db, -kMagnitude_db, colour_of(i));
  }
  return panel;
}

plot::Panel phase_panel(const TuningStudy& study, std::size_t loop) {
  plot::Panel panel = bode_panel(study, loop, 2, {"phase (deg)", kPhaseBottom, kPhaseTop});
  add_level(panel, -180.0);
  for (std::size_t i = 0; i < study.settings.size(); ++i) {
    const LoopStudy& one = study.settings[i].loops[loop];
    add_curve(panel, one, one.phase_deg, -180.0, colour_of(i));
  }
  return panel;
}

}  // namespace

plot::Figure tuning_figure(const TuningStudy& study) {
  plot::Figure figure{
      study.vehicle + ": " + delay_text(study) + "; margins of phase (PM), gain (GM), delay (DM)",
      kWidth,
      kHeight,
      {}};
  for (std::size_t loop = 0; loop < control::kFlownLoopNames.size(); ++loop) {
    figure.panels.push_back(step_panel(study, loop));
    figure.panels.push_back(magnitude_panel(study, loop));
    figure.panels.push_back(phase_panel(study, loop));
  }
  return figure;
}

std::string draw_tuning(const std::filesystem::path& png, const TuningStudy& study) {
  return plot::draw_png(tuning_figure(study), png);
}

}  // namespace swiftlet::analysis

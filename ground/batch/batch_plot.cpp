#include "swiftlet/ground/batch/batch_plot.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <stdexcept>

#include <fmt/core.h>

#include "swiftlet/ground/report/gnuplot.hpp"
#include "swiftlet/io/format.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::size_t kMostScatters = 3;
constexpr double kLongTail = 4.0;  // maximum over median, above which the error axis is logarithmic

constexpr const char* kPlot = R"(
# Draws batch.png from batch.csv: run `gnuplot batch.gp` in this folder.
set terminal pngcairo size 1600,1100 font 'DejaVu Sans,12' noenhanced
set output 'batch.png'
set datafile separator ','
csv = 'batch.csv'

set multiplot title headline font 'DejaVu Sans,15'
set style line 1 lc rgb '#1f6fb4' lw 2.4
set style line 2 lc rgb '#b03a2e' lw 2.4
set style line 3 lc rgb '#1f6fb4' pt 7 ps 0.6
set style line 4 lc rgb '#b03a2e' pt 7 ps 0.9
set style line 5 lc rgb '#1a1a1a' lw 1.4 dt (8,6)
set style line 9 lc rgb '#dddddd' lw 0.8
set grid ls 9
set border lc rgb '#555555'
set tics nomirror
ok(value) = column('completed') == 1 ? value : NaN
failed(value) = column('completed') == 0 ? value : NaN
mm(name) = 1e3 * column(name)

# Cumulative distribution of the errors.
set tmargin at screen 0.925; set bmargin at screen 0.575
set lmargin at screen 0.060; set rmargin at screen 0.470
set logscale x
set xrange [error_from:error_to]
set yrange [0:102]
set xlabel 'tracking error, 3-D (mm)'
set ylabel 'share of the runs at or below (%)' offset 1
set key at graph 0.5,1.01 center bottom horizontal maxrows 1
set arrow 1 from tolerance, graph 0 to tolerance, graph 1 nohead ls 5 front
plot csv using (mm('rms_3d_m')):(100.0 / runs) smooth cumulative with fsteps ls 1 title 'RMS', \
     csv using (mm('peak_3d_m')):(100.0 / runs) smooth cumulative with fsteps ls 2 title 'peak', \
     NaN with lines ls 5 title 'tolerance on the peak'
unset arrow 1
unset logscale x

# Phase margins of the loops.
set lmargin at screen 0.560; set rmargin at screen 0.975
set xrange [0.4:6.6]
set yrange [*:*]
set offsets 0, 0, 4, 4
set style fill solid 0.25
set boxwidth 0.5
set style boxplot fraction 0.90 outliers pointtype 7
set pointsize 0.35
set xtics ('roll' 1, 'pitch' 2, 'yaw' 3, 'x' 4, 'y' 5, 'z' 6)
unset xlabel
set ylabel 'phase margin (deg)' offset 1
set key at graph 0.5,1.01 center bottom horizontal maxrows 1
plot for [i = 1:6] csv using (i):(column(i + 6)) with boxplot lc rgb '#1f6fb4' lw 1.4 notitle, \
     '+' using (NaN):(NaN) with boxes lc rgb '#1f6fb4' title 'quartiles and 90 % of the runs', \
     designed using 1:2:(0.36) with xerrorbars lc rgb '#b03a2e' lw 2.4 pt 0 title 'nominal vehicle'
set offsets 0, 0, 0, 0
set xtics autofreq

# The RMS error against the parameters with the strongest rank correlation.
unset key
set tmargin at screen 0.445; set bmargin at screen 0.085
set offsets graph 0.03, graph 0.03, graph 0.12, 0
set xrange [*:*]
set autoscale xfix
set format x '%.3g'
)";

constexpr const char* kScatter =
    R"(plot csv using (column(name) / scale):(ok(mm('rms_3d_m'))) with points ls 3, \
     csv using (column(name) / scale):(failed(mm('rms_3d_m'))) with points ls 4
)";

// Returns the power of a thousand that keeps the tick labels of an axis short.
double axis_scale(const BatchReport& report, const std::string& name) {
  const auto index = static_cast<std::size_t>(
      std::find(report.parameters.begin(), report.parameters.end(), name) - report.parameters.begin());
  double largest = 0.0;
  for (const BatchRun& run : report.batch.runs) largest = std::max(largest, std::abs(run.values[index]));
  const double exponent = largest > 0.0 ? std::floor(std::log10(largest)) : 0.0;
  const bool reads_well = exponent >= -1.0 && exponent <= 3.0;
  return reads_well ? 1.0 : std::pow(10.0, 3.0 * std::floor(exponent / 3.0));
}

std::string axis_label(const std::string& name, double scale) {
  const auto& known = parameters();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const Parameter& p) { return p.name == name; });
  std::string unit = found == known.end() || found->unit == "1" ? "" : found->unit;
  if (found != known.end() && found->unit.empty()) unit = "times nominal";
  if (scale != 1.0) unit = fmt::format("{:g} ", scale) + unit;
  return unit.empty() ? name : name + " (" + unit + ")";
}

void write_scatters(std::ostream& script, const BatchReport& report) {
  const bool long_tail = report.rms_3d_m.max > kLongTail * report.rms_3d_m.median;
  if (long_tail)
    script << "set logscale y\nset offsets graph 0.03, graph 0.03, 0, 0\n"
           << fmt::format("set yrange [{:.6g}:{:.6g}]\n", 0.8e3 * report.rms_3d_m.min,
                          3e3 * report.rms_3d_m.max);
  else
    script << "set yrange [0:*]\n";
  const std::size_t count = std::min(kMostScatters, report.effects.size());
  for (std::size_t i = 0; i < count; ++i) {
    const ParameterEffect& effect = report.effects[i];
    if (effect.strength() < 0.0) break;
    const double scale = axis_scale(report, effect.name);
    const double left = 0.060 + 0.3225 * static_cast<double>(i);
    script << fmt::format("set lmargin at screen {:.4f}; set rmargin at screen {:.4f}\n", left, left + 0.260)
           << "set xlabel " << gnuplot_quoted(axis_label(effect.name, scale)) << "\n"
           << (i == 0 ? "set ylabel 'tracking error, RMS (mm)' offset 1\n" : "unset ylabel\n")
           << fmt::format(
                  "set label 1 'rank correlation {:+.2f}, distance {:+.2f}' at graph 0.03,0.95 front\n",
                  effect.of_value, effect.of_distance)
           << "name = '" << effect.name << "'\nscale = " << fmt::format("{:g}", scale) << "\n"
           << kScatter;
  }
}

void write_script(const std::filesystem::path& file, const BatchReport& report) {
  const Batch& batch = report.batch;
  std::ofstream script(file);
  script << "headline = "
         << gnuplot_quoted(report.mission + " - " + report.vehicle + ", " + report.control + ", dispersion " +
                           report.dispersion + ": " + counted(batch.runs.size(), "run") +
                           fmt::format(", {} failed", batch.failed()) + (batch.failed() > 0 ? " (red)" : ""))
         << "\nruns = " << report.rms_3d_m.count
         << fmt::format("\ntolerance = {:.6g}", report.tolerance_m * 1e3)
         << fmt::format("\nerror_from = {:.6g}", 0.8e3 * report.rms_3d_m.min)
         << fmt::format("\nerror_to = {:.6g}", 1.25e3 * std::max(report.tolerance_m, report.peak_3d_m.max))
         << "\n$designed << EOD\n";
  const std::array<double, 6> designed = as_array(batch.designed_deg);
  for (std::size_t i = 0; i < designed.size(); ++i)
    if (std::isfinite(designed[i])) script << fmt::format("{},{:.4f}\n", i + 1, designed[i]);
  script << "EOD\ndesigned = '$designed'\n" << kPlot;
  write_scatters(script, report);
  script << "unset multiplot\n";
  if (!script.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace

std::string draw_batch(const std::filesystem::path& folder, const BatchReport& report) {
  if (report.rms_3d_m.count == 0) return "no picture was drawn: no run has a tracking error";
  write_script(folder / "batch.gp", report);
  return run_gnuplot(folder, "batch");
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/report/flight_files.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/report/gnuplot.hpp"
#include "swiftlet/io/csv_writer.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kLongestRowGapNs = 15'000'000;  // references are published every 10 ms

// Returns the row with this stamp and advances `at` to it; null if there is none.
template <class Row>
const Row* row_at(const Row*& at, const Row* end, std::int64_t stamp_ns) {
  while (at != end && at->stamp_ns < stamp_ns) ++at;
  return at != end && at->stamp_ns == stamp_ns ? at : nullptr;
}

std::string number(double value) { return fmt::format("{:.4g}", value); }

constexpr const char* kPlot = R"(
# Draws flight.png from flight.csv: run `gnuplot flight.gp` in this folder.
set terminal pngcairo size 1600,1150 font 'DejaVu Sans,12' noenhanced
set output 'flight.png'
set datafile separator ','
csv = 'flight.csv'
stats csv using 'px' name 'north' nooutput
stats csv using 'py' name 'east' nooutput
stats csv using 'pz' name 'down' nooutput
larger(a, b) = a > b ? a : b
north_middle = 0.5 * (north_min + north_max)
east_middle = 0.5 * (east_min + east_max)
plan_reach = larger(0.5 * larger(north_max - north_min, east_max - east_min) + 0.25, 0.5)
view_reach = larger(plan_reach - 0.05, larger(-down_min, 0))  # a tall flight in a box as wide as it is tall

set multiplot title headline font 'DejaVu Sans,15'
set style line 1 lc rgb '#5b9bd5' lw 3.2            # flown
set style line 2 lc rgb '#1a1a1a' lw 1.2 dt (10,6)  # reference, on top of it
set style line 3 lc rgb '#b03a2e' lw 1.1
set style line 4 lc rgb '#2e8b57' lw 1.1
set style line 5 lc rgb '#7d4fa1' lw 1.1
set style line 6 lc rgb '#222222' lw 1.8
set style line 9 lc rgb '#dddddd' lw 0.8
set grid ls 9
set border lc rgb '#555555'
set tics nomirror
set xrange [t_from:t_to]
set lmargin at screen 0.065
set rmargin at screen 0.520

set key at graph 0.99,0.96 right top horizontal
set format x ''
set tmargin at screen 0.935; set bmargin at screen 0.735
set ylabel 'north x (m)' offset 1
set yrange [-2.2:2.2]; set autoscale y; set offsets 0,0,0.15,0.1
plot csv using 't':'px' with lines ls 1 title 'flown', csv using 't':'ref_px' with lines ls 2 title 'reference'
unset key
set tmargin at screen 0.715; set bmargin at screen 0.515
set ylabel 'east y (m)'
plot csv using 't':'py' with lines ls 1, csv using 't':'ref_py' with lines ls 2
set tmargin at screen 0.495; set bmargin at screen 0.295
set ylabel 'down z (m)'
set yrange [*:*] reverse
plot csv using 't':'pz' with lines ls 1, csv using 't':'ref_pz' with lines ls 2
set yrange [*:*] noreverse
set tmargin at screen 0.275; set bmargin at screen 0.065
set format x '%g'
set xlabel 'time (s)' offset 0,0.4
set ylabel 'error, flown - reference (mm)'
set offsets 0,0,2,0
set key at graph 0.99,0.97 right top horizontal
in_window(t) = (t >= 0 && t < t_land) ? 1 : NaN
mm(a, r) = 1e3 * (a - r)
plot csv using (column('t')):(in_window(column('t')) * mm(column('px'), column('ref_px'))) with lines ls 3 title 'x', \
     csv using (column('t')):(in_window(column('t')) * mm(column('py'), column('ref_py'))) with lines ls 4 title 'y', \
     csv using (column('t')):(in_window(column('t')) * mm(column('pz'), column('ref_pz'))) with lines ls 5 title 'z', \
     csv using (column('t')):(in_window(column('t')) * sqrt(mm(column('px'), column('ref_px'))**2 + mm(column('py'), column('ref_py'))**2 + mm(column('pz'), column('ref_pz'))**2)) with lines ls 6 title '3-D'

unset key
set offsets 0,0,0,0
set xrange [east_middle - plan_reach:east_middle + plan_reach]
set yrange [north_middle - plan_reach:north_middle + plan_reach]
set xlabel 'east y (m)' offset 0,0.4
set ylabel 'north x (m)' offset 1
set lmargin at screen 0.590; set rmargin at screen 0.975
set tmargin at screen 0.935; set bmargin at screen 0.500
set size ratio -1
set label 1 'plan view' at graph 0.03,0.95 front
plot csv using 'py':'px' with lines ls 1, csv using 'ref_py':'ref_px' with lines ls 2
unset label 1

set xrange [east_middle - view_reach:east_middle + view_reach]
set yrange [north_middle - view_reach:north_middle + view_reach]
set size noratio
set lmargin at screen 0.600; set rmargin at screen 0.960
set tmargin at screen 0.430; set bmargin at screen 0.060
set view 62,35
set view equal xyz
set xyplane at 0
set zrange [0:*]
set ztics 0.5
set xtics 0.5 offset -0.8,-0.3; set ytics 0.5 offset 0.9,-0.1
set xlabel 'east y (m)' offset 0,-0.5; set ylabel 'north x (m)' offset 0,-0.5; set zlabel 'height -z (m)' rotate by 90 offset -1
splot csv using 'py':'px':(-column('pz')) with lines ls 1, \
      csv using 'ref_py':'ref_px':(-column('ref_pz')) with lines ls 2
unset multiplot
)";

void write_script(const std::filesystem::path& file, const FlightReport& report, Window window) {
  std::ofstream script(file);
  const double land_s = window.duration_s();
  const std::string figures =
      fmt::format(": 3-D error RMS {:.1f} mm, peak {:.1f} mm over {:.0f} s", report.errors.rms_3d_m * 1e3,
                  report.errors.peak_3d_m * 1e3, land_s);
  script << "headline = "
         << gnuplot_quoted(report.mission + " - " + report.vehicle + ", " + report.control + figures +
                           (report.completed ? "" : " - NOT completed"))
         << "\n"
         << "t_from = 0\nt_land = " << number(land_s)
         << "\nt_to = " << number(std::max(report.duration_s, 1.0) + 0.5) << "\n"
         << kPlot;
  if (!script.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

}  // namespace

void write_flight_csv(const std::filesystem::path& file, const FlightRecord& record, Window window) {
  const auto rotors = static_cast<std::size_t>(record.truth.empty() ? 0 : record.truth.back().rotor_count);
  std::vector<std::string> columns = {
      "t",      "mode",    "px",     "py",     "pz",     "vx",     "vy",     "vz",     "qw",     "qx",
      "qy",     "qz",      "p",      "q",      "r",      "ref_px", "ref_py", "ref_pz", "ref_vx", "ref_vy",
      "ref_vz", "ref_yaw", "est_px", "est_py", "est_pz", "est_vx", "est_vy", "est_vz", "v_s"};
  for (std::size_t i = 1; i <= rotors; ++i) columns.push_back("om" + std::to_string(i));
  runtime::CsvWriter csv(file, columns);

  const ReferenceRow* next_reference = record.reference.begin();
  const EstimateRow* next_estimate = record.estimate.begin();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min() / 2;
  for (const TruthRow& truth : record.truth) {
    const ReferenceRow* reference = row_at(next_reference, record.reference.end(), truth.stamp_ns);
    if (reference == nullptr && truth.stamp_ns - last_ns < kLongestRowGapNs) continue;
    last_ns = truth.stamp_ns;
    const EstimateRow* estimate = row_at(next_estimate, record.estimate.end(), truth.stamp_ns);
    csv.fixed(static_cast<double>(truth.stamp_ns - window.from_ns) * 1e-9, 6);
    if (reference != nullptr) {
      csv.number(reference->mode);
    } else {
      csv.empty();
    }
    csv.numbers(truth.position_ned).numbers(truth.velocity_ned).numbers(truth.q_ned_from_frd);
    csv.numbers(truth.body_rates_frd);
    if (reference != nullptr) {
      csv.numbers(reference->position_ned).numbers(reference->velocity_ned).number(reference->yaw_rad);
    } else {
      csv.empty(7);
    }
    if (estimate != nullptr) {
      csv.numbers(estimate->position_ned).numbers(estimate->velocity_ned);
    } else {
      csv.empty(6);
    }
    csv.number(truth.supply_voltage_v, 6);
    for (std::size_t i = 0; i < rotors; ++i) csv.number(truth.rotor_speeds[i]);
    csv.end_row();
  }
  csv.finish();
}

void write_report_json(const std::filesystem::path& file, const FlightReport& report) {
  std::ofstream json(file);
  json << to_json(report).dump(2) << "\n";
  if (!json.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

std::string draw_flight(const std::filesystem::path& folder, const FlightReport& report, Window window) {
  write_script(folder / "flight.gp", report, window);
  return run_gnuplot(folder, "flight");
}

}  // namespace swiftlet::ground

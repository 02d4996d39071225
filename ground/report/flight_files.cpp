#include "swiftlet/ground/report/flight_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/ground/plot/gnuplot.hpp"
#include "swiftlet/ground/plot/path_figure.hpp"
#include "swiftlet/io/csv_writer.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::int64_t kLongestRowGapNs = 15'000'000;  // references are published every 10 ms
constexpr double kLeastSpan_m = 0.25;                  // of a position axis, so that noise does not fill it

// Returns the row with this stamp and advances `at` to it; null if there is none.
template <class Row>
const Row* row_at(const Row*& at, const Row* end, std::int64_t stamp_ns) {
  while (at != end && at->stamp_ns < stamp_ns) ++at;
  return at != end && at->stamp_ns == stamp_ns ? at : nullptr;
}

double seconds(std::int64_t duration_ns) { return static_cast<double>(duration_ns) * 1e-9; }

// Visits each ground truth sample that has a reference of the same stamp, with the estimate of that stamp or
// null. Without references, visits one about every 15 ms, with null.
template <class Visit>
void for_each_row(const FlightRecord& record, const Visit& visit) {
  const ReferenceRow* next_reference = record.reference.begin();
  const EstimateRow* next_estimate = record.estimate.begin();
  std::int64_t last_ns = std::numeric_limits<std::int64_t>::min() / 2;
  for (const TruthRow& truth : record.truth) {
    const ReferenceRow* reference = row_at(next_reference, record.reference.end(), truth.stamp_ns);
    if (reference == nullptr && truth.stamp_ns - last_ns < kLongestRowGapNs) continue;
    last_ns = truth.stamp_ns;
    visit(truth, reference, row_at(next_estimate, record.estimate.end(), truth.stamp_ns));
  }
}

plot::Figure flight_figure(const FlightRecord& record, const FlightReport& report, Window window) {
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
  std::vector<plot::Series>& errors_mm = figure.panels[3].series;
  errors_mm = {{Style::kLine, Colour::kOrange, "x", {}, 0.6},
               {Style::kLine, Colour::kGreen, "y", {}, 0.6},
               {Style::kLine, Colour::kPurple, "z", {}, 0.6},
               {Style::kLine, Colour::kInk, "3-D", {}, 1.0}};
  for_each_row(record, [&](const TruthRow& truth, const ReferenceRow* reference, const EstimateRow*) {
    const double t_s = seconds(truth.stamp_ns - window.from_ns);
    const auto add = [&](std::size_t series, const std::array<double, 3>& ned) {
      for (std::size_t i = 0; i < 3; ++i) figure.panels[i].series[series].points.push_back({t_s, ned[i]});
      for (const std::size_t view : {plot::kFromAbove, plot::kInSpace})
        figure.panels[view].series[series].points.push_back({ned[1], ned[0], -ned[2]});
    };
    add(0, truth.position_ned);
    if (reference == nullptr) return;
    add(1, reference->position_ned);
    if (t_s < 0.0 || t_s >= window.duration_s()) return;
    const Eigen::Vector3d error_mm =
        1e3 * (Eigen::Vector3d(truth.position_ned.data()) - Eigen::Vector3d(reference->position_ned.data()));
    for (std::size_t i = 0; i < 3; ++i)
      errors_mm[i].points.push_back({t_s, error_mm[static_cast<Eigen::Index>(i)]});
    errors_mm[3].points.push_back({t_s, error_mm.norm()});
  });
  return figure;
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

  for_each_row(
      record, [&](const TruthRow& truth, const ReferenceRow* reference, const EstimateRow* estimate) {
        csv.fixed(seconds(truth.stamp_ns - window.from_ns), 6);
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
      });
  csv.finish();
}

void write_report_json(const std::filesystem::path& file, const FlightReport& report) {
  std::ofstream json(file);
  json << to_json(report).dump(2) << "\n";
  if (!json.flush()) throw std::runtime_error(file.string() + " cannot be written");
}

std::string draw_flight(const std::filesystem::path& folder, const FlightRecord& record,
                        const FlightReport& report, Window window) {
  return plot::draw_png_if_installed(flight_figure(record, report, window), folder / "flight.png");
}

}  // namespace swiftlet::ground

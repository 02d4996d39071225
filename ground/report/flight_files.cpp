#include "swiftlet/ground/report/flight_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/plot/gnuplot.hpp"
#include "swiftlet/ground/plot/path_figure.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/recording/tracking.hpp"

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

// Whether most references have truth of their stamp, judged by the first ones for which there is truth. That of a vehicle
// which another process flies (swiftlet-plant --truth-only) has stamps of its own, and some may be equal by accident.
bool has_equal_stamps(const FlightRecord& record) {
  constexpr int kMostJudged = 100;
  if (record.truth.empty()) return false;
  const TruthRow* next = record.truth.begin();
  int judged = 0;
  int equal = 0;
  for (const ReferenceRow& reference : record.reference) {
    if (reference.stamp_ns < record.truth.begin()->stamp_ns) continue;
    if (judged == kMostJudged || reference.stamp_ns > record.truth.back().stamp_ns) break;
    ++judged;
    if (row_at(next, record.truth.end(), reference.stamp_ns) != nullptr) ++equal;
  }
  return 2 * equal > judged;
}

// Visits each ground truth sample that has a reference of the same stamp, with the estimate of that stamp or
// null. Without references, visits one about every 15 ms, with null. If most stamps are not equal, the truth is
// interpolated at those of the references.
template <class Visit>
void for_each_row(const FlightRecord& record, const Visit& visit) {
  const ReferenceRow* next_reference = record.reference.begin();
  const EstimateRow* next_estimate = record.estimate.begin();
  if (!record.reference.empty() && !has_equal_stamps(record)) {
    const TruthRow* after = record.truth.begin();
    for (const ReferenceRow& reference : record.reference) {
      while (after != record.truth.end() && after->stamp_ns < reference.stamp_ns) ++after;
      const auto truth = truth_at(record.truth, after, reference.stamp_ns, TruthSource::kInterpolated);
      if (!truth) continue;
      visit(*truth, &reference, row_at(next_estimate, record.estimate.end(), reference.stamp_ns));
    }
    return;
  }
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
    const double t_s = math::seconds(truth.stamp_ns - window.from_ns);
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

std::vector<std::string> flight_columns(std::size_t rotors, bool has_commands) {
  std::vector<std::string> columns = {"t [s]",
                                      "mode",
                                      "x_ned [m]",
                                      "y_ned [m]",
                                      "z_ned [m]",
                                      "vx_ned [m/s]",
                                      "vy_ned [m/s]",
                                      "vz_ned [m/s]",
                                      "qw_ned_from_frd [1]",
                                      "qx_ned_from_frd [1]",
                                      "qy_ned_from_frd [1]",
                                      "qz_ned_from_frd [1]",
                                      "p_frd [rad/s]",
                                      "q_frd [rad/s]",
                                      "r_frd [rad/s]",
                                      "ref_x_ned [m]",
                                      "ref_y_ned [m]",
                                      "ref_z_ned [m]",
                                      "ref_vx_ned [m/s]",
                                      "ref_vy_ned [m/s]",
                                      "ref_vz_ned [m/s]",
                                      "ref_ax_ned [m/s^2]",
                                      "ref_ay_ned [m/s^2]",
                                      "ref_az_ned [m/s^2]",
                                      "ref_yaw_ned [rad]",
                                      "ref_qw_ned_from_frd [1]",
                                      "ref_qx_ned_from_frd [1]",
                                      "ref_qy_ned_from_frd [1]",
                                      "ref_qz_ned_from_frd [1]",
                                      "command_thrust [N]",
                                      "command_moment_x_frd [N*m]",
                                      "command_moment_y_frd [N*m]",
                                      "command_moment_z_frd [N*m]",
                                      "est_x_ned [m]",
                                      "est_y_ned [m]",
                                      "est_z_ned [m]",
                                      "est_vx_ned [m/s]",
                                      "est_vy_ned [m/s]",
                                      "est_vz_ned [m/s]",
                                      "supply_voltage [V]"};
  for (std::size_t i = 1; i <= rotors; ++i) columns.push_back(fmt::format("rotor_speed{} [rad/s]", i));
  for (std::size_t i = 1; i <= rotors && has_commands; ++i)
    columns.push_back(fmt::format("throttle{} [1]", i));
  return columns;
}

void write_reference(runtime::CsvWriter& csv, const ReferenceRow* reference) {
  constexpr int kCells = 18;
  if (reference == nullptr) {
    csv.empty(kCells);
    return;
  }
  csv.numbers(reference->position_ned).numbers(reference->velocity_ned).numbers(reference->acceleration_ned);
  csv.number(reference->yaw_rad).numbers(reference->q_ned_from_frd);
  csv.number(reference->thrust_n).numbers(reference->moment_frd);
}

// Throttles of the command computed from the IMU sample of this stamp; 0 with the rotors off.
void write_throttles(runtime::CsvWriter& csv, const plant::ActuatorCommand* command, std::size_t rotors) {
  for (std::size_t i = 0; i < rotors; ++i) {
    if (command != nullptr) {
      csv.number(command->throttle[i]);
    } else {
      csv.empty();
    }
  }
}

}  // namespace

void write_flight_csv(const std::filesystem::path& file, const FlightRecord& record, Window window) {
  const auto rotors = static_cast<std::size_t>(record.truth.empty() ? 0 : record.truth.back().rotor_count);
  const bool has_commands = record.sensors && !record.sensors->commands.empty();
  runtime::CsvWriter csv(file, flight_columns(rotors, has_commands));
  const plant::ActuatorCommand* next_command = has_commands ? record.sensors->commands.begin() : nullptr;
  const plant::ActuatorCommand* const commands_end = has_commands ? record.sensors->commands.end() : nullptr;

  for_each_row(record,
               [&](const TruthRow& truth, const ReferenceRow* reference, const EstimateRow* estimate) {
                 csv.fixed(math::seconds(truth.stamp_ns - window.from_ns), 6);
                 if (reference != nullptr) {
                   csv.text(control::to_string(static_cast<control::Mode>(reference->mode)));
                 } else {
                   csv.empty();
                 }
                 csv.numbers(truth.position_ned).numbers(truth.velocity_ned).numbers(truth.q_ned_from_frd);
                 csv.numbers(truth.body_rates_frd);
                 write_reference(csv, reference);
                 if (estimate != nullptr) {
                   csv.numbers(estimate->position_ned).numbers(estimate->velocity_ned);
                 } else {
                   csv.empty(6);
                 }
                 csv.number(truth.supply_voltage_v, 6);
                 for (std::size_t i = 0; i < rotors; ++i) csv.number(truth.rotor_speeds[i]);
                 if (has_commands)
                   write_throttles(csv, row_at(next_command, commands_end, truth.stamp_ns), rotors);
                 csv.end_row();
               });
  csv.finish();
}

void write_report_json(const std::filesystem::path& file, const FlightReport& report) {
  runtime::write_atomically(file, to_json(report).dump(2) + "\n");
}

std::string draw_flight(const std::filesystem::path& folder, const FlightRecord& record,
                        const FlightReport& report, Window window) {
  return plot::draw_png_if_installed(flight_figure(record, report, window), folder / "flight.png");
}

}  // namespace swiftlet::ground

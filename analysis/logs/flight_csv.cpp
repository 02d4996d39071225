#include "swiftlet/analysis/logs/flight_csv.hpp"

#include <string>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::analysis {
namespace {

// Returns the row with this stamp and advances `at` to it; null if there is none.
template <class Row>
const Row* row_at(const std::vector<Row>& rows, std::size_t& at, std::int64_t stamp_ns) {
  while (at < rows.size() && rows[at].stamp_ns < stamp_ns) ++at;
  return at < rows.size() && rows[at].stamp_ns == stamp_ns ? &rows[at] : nullptr;
}

std::vector<std::string> columns_of(std::size_t rotors) {
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
  for (std::size_t i = 1; i <= rotors; ++i) columns.push_back(fmt::format("throttle{} [1]", i));
  return columns;
}

}  // namespace

void write_flight_csv(const std::filesystem::path& file, const record::Flight& flight) {
  const auto rotors = static_cast<std::size_t>(flight.truth.empty() ? 0 : flight.truth.back().rotor_count);
  const record::Window window = record::evaluate(flight).window.value_or(record::Window{});
  io::CsvWriter csv(file, columns_of(rotors));
  auto after = flight.truth.begin();
  std::size_t estimate_row = 0, command_row = 0;
  for (const record::ReferenceRow& reference : flight.reference) {
    while (after != flight.truth.end() && after->stamp_ns < reference.stamp_ns) ++after;
    const auto truth = record::motion_at(flight.truth, after, reference.stamp_ns);
    const record::EstimateRow* const estimate = row_at(flight.estimate, estimate_row, reference.stamp_ns);
    const plant::ActuatorCommand* const command = row_at(flight.commands, command_row, reference.stamp_ns);
    if (!truth) continue;
    csv.fixed(math::seconds(reference.stamp_ns - window.from_ns), 6);
    csv.text(control::to_string(static_cast<control::Mode>(reference.mode)));
    csv.numbers(truth->position_ned).numbers(truth->velocity_ned).numbers(truth->q_ned_from_frd);
    csv.numbers(truth->body_rates_frd);
    csv.numbers(reference.position_ned).numbers(reference.velocity_ned).numbers(reference.acceleration_ned);
    csv.number(reference.yaw_rad).numbers(reference.q_ned_from_frd);
    csv.number(reference.thrust_n).numbers(reference.moment_frd);
    if (estimate != nullptr) {
      csv.numbers(estimate->position_ned).numbers(estimate->velocity_ned);
    } else {
      csv.empty(6);
    }
    csv.number(truth->supply_voltage_v, 6);
    for (std::size_t i = 0; i < rotors; ++i) csv.number(truth->rotor_speeds[i]);
    for (std::size_t i = 0; i < rotors; ++i) {
      if (command != nullptr) {
        csv.number(command->throttle[i]);
      } else {
        csv.empty();
      }
    }
    csv.end_row();
  }
  csv.finish();
}

}  // namespace swiftlet::analysis

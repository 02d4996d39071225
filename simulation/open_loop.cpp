#include "swiftlet/simulation/open_loop.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "swiftlet/io/csv_writer.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/simulation/dynamics.hpp"

namespace swiftlet::simulation {
namespace {

constexpr std::int64_t kRowPeriodNs = 1'000'000;
constexpr double kMaxStepS = 2e-5;
// Largest rotation of the body in one step; the attitude error is then 1e-8 after one second.
constexpr double kMaxTurnRad = 0.01;
constexpr double kFastestTurn = 1e4;   // rad/s, limit of the body rate during the run
constexpr double kLargest = 1e6;       // limit of initial positions, velocities and rotor speeds, SI
constexpr double kFastestStart = 2e3;  // rad/s, limit of initial body rates
constexpr double kUnitTolerance = 1e-3;
constexpr double kLatestTimeS = 1e6;    // keeps nanoseconds exact
constexpr double kLongestRunS = 600.0;  // bounds the memory of the result

bool finite(const plant::VehicleState& state) {
  return state.position_ned.allFinite() && state.velocity_ned.allFinite() &&
         state.body_rates_frd.allFinite() && state.q_ned_from_frd.coeffs().allFinite();
}

// Integrates up to until_ns, in steps that are short enough for the body rate. Throws std::runtime_error if
// the rate is above kFastestTurn.
void advance(const plant::Dynamics& dynamics, MotionRow& now, const plant::MotorCommand& drive,
             std::int64_t until_ns) {
  const double dt = static_cast<double>(until_ns - now.time_ns) * 1e-9;
  const double rate = now.state.body_rates_frd.norm();
  if (!(rate < kFastestTurn) || !finite(now.state)) {
    throw std::runtime_error("the body rate is " + io::exact(rate) +
                             " rad/s at t = " + io::exact(static_cast<double>(now.time_ns) / math::kNsPerS) +
                             " s, must be below " + io::exact(kFastestTurn) + " rad/s");
  }
  const int count = static_cast<int>(std::ceil(dt * std::max(1.0 / kMaxStepS, rate / kMaxTurnRad)));
  for (int i = 0; i < count; ++i) dynamics.advance(now.state, drive, Eigen::Vector3d::Zero(), dt / count);
  now.time_ns = until_ns;
}

std::vector<double> values(const plant::VehicleState& state, int rotor_count) {
  const auto& p = state.position_ned;
  const auto& v = state.velocity_ned;
  const auto& q = state.q_ned_from_frd;
  const auto& w = state.body_rates_frd;
  std::vector<double> out = {p.x(), p.y(), p.z(), v.x(), v.y(), v.z(), q.w(),
                             q.x(), q.y(), q.z(), w.x(), w.y(), w.z()};
  out.insert(out.end(), state.rotor_speeds.begin(), state.rotor_speeds.begin() + rotor_count);
  return out;
}

}  // namespace

std::vector<std::string> pulse_columns(int rotor_count) {
  std::vector<std::string> columns = {"t"};
  for (int i = 1; i <= rotor_count; ++i) columns.push_back("pwm" + std::to_string(i));
  return columns;
}

std::vector<std::string> state_columns(int rotor_count) {
  std::vector<std::string> columns = {"px", "py", "pz", "vx", "vy", "vz", "qw",
                                      "qx", "qy", "qz", "p",  "q",  "r"};
  for (int i = 1; i <= rotor_count; ++i) columns.push_back("om" + std::to_string(i));
  return columns;
}

std::vector<PulseWidths> read_pulses(const io::Table& table, const plant::Vehicle& vehicle) {
  const io::Bounds range =
      io::between(vehicle.esc.pulse_min_us, vehicle.esc.pulse_min_us + vehicle.esc.pulse_range_us);
  std::vector<PulseWidths> pulses(table.row_count());
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    pulses[row].time_ns =
        math::nanoseconds(table.number(row, 0, io::between(-kLatestTimeS, kLatestTimeS), "s"));
    if (row > 0 && pulses[row].time_ns <= pulses[row - 1].time_ns) {
      table.fail(row, "t",
                 "is " + io::exact(table.number(row, 0)) + ", must be above the row before, " +
                     io::exact(table.number(row - 1, 0)));
    }
    if (table.number(row, 0) - table.number(0, 0) > kLongestRunS) {
      table.fail(row, "t",
                 "is " + io::exact(table.number(row, 0) - table.number(0, 0)) +
                     " s after the first row, must be at most " + io::exact(kLongestRunS) + " s");
    }
    for (std::size_t i = 0; i + 1 < table.column_count(); ++i) {
      pulses[row].throttle[i] =
          plant::throttle_from_pulse_width(vehicle.esc, table.number(row, i + 1, range, "microseconds"));
    }
  }
  return pulses;
}

plant::VehicleState read_state(const io::Table& table, int rotor_count) {
  if (table.row_count() != 1) table.fail(1, "", "is a second row, the limit is one row");
  const auto value = [&](std::size_t column) {
    return table.number(0, column, io::between(-kLargest, kLargest));
  };
  plant::VehicleState state;
  state.position_ned = {value(0), value(1), value(2)};
  state.velocity_ned = {value(3), value(4), value(5)};
  state.q_ned_from_frd = Eigen::Quaterniond(value(6), value(7), value(8), value(9));
  const double norm = state.q_ned_from_frd.norm();
  if (std::abs(norm - 1.0) > kUnitTolerance) {
    table.fail(0, "qw,qx,qy,qz",
               "has length " + io::exact(norm) + ", must be 1 within " + io::exact(kUnitTolerance));
  }
  state.q_ned_from_frd.normalize();
  const auto rate = [&](std::size_t column) {
    return table.number(0, column, io::between(-kFastestStart, kFastestStart), "rad/s");
  };
  state.body_rates_frd = {rate(10), rate(11), rate(12)};
  for (int i = 0; i < rotor_count; ++i) {
    const auto n = static_cast<std::size_t>(i);
    state.rotor_speeds[n] = table.number(0, 13 + n, io::between(0.0, kLargest), "rad/s");
  }
  return state;
}

std::vector<MotionRow> simulate_open_loop(const plant::Vehicle& vehicle, double supply_voltage_v,
                                          const plant::VehicleState& initial,
                                          const std::vector<PulseWidths>& pulses) {
  plant::Vehicle without_drag = vehicle;
  without_drag.linear_drag = 0.0;
  const plant::Dynamics dynamics(without_drag, plant::Supply::constant(supply_voltage_v));

  MotionRow now{pulses.front().time_ns, initial};
  plant::MotorCommand drive{plant::RotorState::kRunning, pulses.front().throttle};
  now.state.armature_currents = dynamics.settled_currents(now.state, drive);
  std::vector<MotionRow> rows = {now};
  std::size_t held = 0;
  std::int64_t next_row_ns = now.time_ns + kRowPeriodNs;
  while (held + 1 < pulses.size()) {
    drive.throttle = pulses[held].throttle;
    advance(dynamics, now, drive, std::min(next_row_ns, pulses[held + 1].time_ns));
    if (now.time_ns == next_row_ns) {
      rows.push_back(now);
      next_row_ns += kRowPeriodNs;
    }
    if (now.time_ns == pulses[held + 1].time_ns) ++held;
  }
  return rows;
}

void write_motion(const std::string& path, const std::vector<MotionRow>& rows, int rotor_count) {
  std::vector<std::string> columns = state_columns(rotor_count);
  columns.insert(columns.begin(), "t");
  io::CsvWriter csv(path, columns);
  for (const MotionRow& row : rows) {
    csv.exact(static_cast<double>(row.time_ns) / math::kNsPerS);
    for (const double value : values(row.state, rotor_count)) csv.exact(value);
    csv.end_row();
  }
  csv.finish();
}

}  // namespace swiftlet::simulation

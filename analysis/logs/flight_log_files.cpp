#include "swiftlet/analysis/logs/flight_log_files.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "swiftlet/analysis/logs/compressed_file.hpp"
#include "swiftlet/io/config_error.hpp"
#include "swiftlet/io/csv.hpp"
#include "swiftlet/io/flight_csv.hpp"
#include "swiftlet/io/measurements.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/record/file/flight_reader.hpp"

namespace swiftlet::analysis {
namespace {

namespace fs = std::filesystem;
using identification::FlightLog;
using identification::FlightPose;
using io::ConfigError;
using io::Measurements;
using io::Quantity;

constexpr double kLongestTimeGap = 3600.0;  // s
constexpr double kNearGravity =
    0.5;  // of g; a larger mean specific force along z shows the direction of the z axis

// Finds the newest row up to a stamp. Calls must have rising stamps.
template <class Row>
class Newest {
 public:
  explicit Newest(const std::vector<Row>& rows) : rows_(rows) {}

  bool none() const { return rows_.empty(); }
  const Row* at(std::int64_t stamp_ns) {
    while (next_ < rows_.size() && rows_[next_].stamp_ns <= stamp_ns) ++next_;
    return next_ == 0 ? nullptr : &rows_[next_ - 1];
  }
  const Row* following() const { return next_ < rows_.size() ? &rows_[next_] : nullptr; }

 private:
  const std::vector<Row>& rows_;
  std::size_t next_ = 0;
};

double voltage_at(const plant::BatterySample& before, const plant::BatterySample* after,
                  std::int64_t stamp_ns) {
  if (after == nullptr) return before.voltage_v;
  const double share = static_cast<double>(stamp_ns - before.stamp_ns) /
                       static_cast<double>(after->stamp_ns - before.stamp_ns);
  return before.voltage_v + share * (after->voltage_v - before.voltage_v);
}

std::vector<Quantity> flight_quantities() {
  std::vector<Quantity> all = {Quantity::kTime};
  for (int i = 0; i < 3; ++i) all.push_back(Quantity::kSpecificForceX + i);
  for (int i = 0; i < 3; ++i) all.push_back(Quantity::kBodyRateX + i);
  for (int i = 0; i < plant::kMaxRotors; ++i) all.push_back(Quantity::kMotorCommand + i);
  for (int i = 0; i < plant::kMaxRotors; ++i) all.push_back(Quantity::kMotorPulse + i);
  all.insert(all.end(), {Quantity::kRunning, Quantity::kSupplyVoltage});
  for (int i = 0; i < plant::kMaxRotors; ++i) all.push_back(Quantity::kMotorSpeed + i);
  all.push_back(Quantity::kPoseTime);
  for (int i = 0; i < 3; ++i) all.push_back(Quantity::kPositionX + i);
  for (int i = 0; i < 4; ++i) all.push_back(Quantity::kOrientationW + i);
  return all;
}

std::vector<Eigen::Vector3d> vectors(const Measurements& table, Quantity x) {
  std::vector<Eigen::Vector3d> out(table.row_count());
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double>& column = table.column(x + axis);
    for (std::size_t row = 0; row < out.size(); ++row) out[row][axis] = column[row];
  }
  return out;
}

int motors(const Measurements& table, Quantity first) {
  int count = 0;
  while (count < plant::kMaxRotors && table.has(first + count)) ++count;
  for (int later = count + 1; later < plant::kMaxRotors; ++later) {
    if (!table.has(first + later)) continue;
    throw ConfigError(table.file(), 1, "header",
                      "has " + table.header(first + later) + " but none of motor " +
                          std::to_string(count + 1) + ", must number motors from 1 without gaps");
  }
  return count;
}

// Returns whether the column names have the first of two endings; nothing if none of them has either. Throws
// if the columns differ.
std::optional<bool> has_first_ending(const Measurements& table, const std::vector<Quantity>& columns,
                                     const std::string& first, const std::string& second) {
  std::optional<bool> declared;
  bool any_without = false;
  for (const Quantity column : columns) {
    const std::string& header = table.header(column);
    const bool is_first = header.find(first) != std::string::npos;
    const bool is_second = header.find(second) != std::string::npos;
    any_without = any_without || !(is_first || is_second);
    if (!(is_first || is_second)) continue;
    if ((declared && *declared != is_first))
      throw ConfigError(table.file(), 1, "header", "mixes " + first + " and " + second);
    declared = is_first;
  }
  if (declared && any_without)
    throw ConfigError(
        table.file(), 1, "header",
        "names axes in some columns only; must end all names in " + first + " or all in " + second);
  return declared;
}

// Returns whether the body axes are forward-right-down; otherwise they are forward-left-up.
bool is_frd(const Measurements& table, const std::vector<Eigen::Vector3d>& specific_force, BodyAxes axes,
            std::vector<std::string>& assumptions) {
  std::vector<Quantity> columns;
  for (int i = 0; i < 3; ++i)
    columns.insert(columns.end(), {Quantity::kSpecificForceX + i, Quantity::kBodyRateX + i});
  std::optional<bool> declared = has_first_ending(table, columns, "_frd", "_flu");
  if (axes != BodyAxes::kDetected) {
    const bool frd = axes == BodyAxes::kFrd;
    if (declared && *declared != frd)
      throw ConfigError(
          table.file(), 1, "header",
          std::string("names ") + (*declared ? "_frd" : "_flu") + " axes, but --axes names others");
    declared = frd;
  }
  double mean = 0.0;
  // The vehicle is upright in the first half of a log; at the end it may lie upside down.
  const std::size_t upright = std::max<std::size_t>(specific_force.size() / 2, 1);
  for (std::size_t row = 0; row < upright; ++row)
    mean += specific_force[row].z() / static_cast<double>(upright);
  const bool shows_gravity = std::abs(mean) > kNearGravity * plant::kGravity;
  if (declared && shows_gravity && *declared != (mean < 0.0)) {
    throw ConfigError(
        table.file(), 1, "specific_force_z",
        "has the mean " + std::to_string(mean) + " m/s^2, must be " +
            (*declared ? "negative in forward-right-down axes" : "positive in forward-left-up axes") +
            "; check the axes");
  }
  if (declared) return *declared;
  if (!shows_gravity) {
    throw ConfigError(
        table.file(), 1, "header",
        "does not name its body axes, and gravity does not show them: the mean specific force along z is " +
            std::to_string(mean) + " m/s^2, must be about 9.8 or -9.8 in hover; check its unit, or give " +
            "--axes frd or --axes flu");
  }
  assumptions.push_back(
      mean < 0.0 ? "body axes are taken as forward-right-down: the specific force along z is negative"
                 : "body axes are taken as forward-left-up: the specific force along z is positive");
  return mean < 0.0;
}

// Refuses implausible pulse widths. Flight controllers send pulses somewhat beyond the ESC's range, to start
// or stop it reliably.
void require_pulse(const Measurements& table, std::size_t row, Quantity which, const plant::Vehicle& base) {
  const double pulse_us = table.column(which)[row];
  const double least_us = base.esc.pulse_min_us - 0.5 * base.esc.pulse_range_us;
  const double most_us = base.esc.pulse_min_us + 1.5 * base.esc.pulse_range_us;
  if (pulse_us == 0.0 || (pulse_us >= least_us && pulse_us <= most_us)) return;
  throw ConfigError(table.file(), table.line(row), table.header(which),
                    "is " + std::to_string(pulse_us) + " us, must be 0 or between " +
                        std::to_string(least_us) + " and " + std::to_string(most_us) + " us: the range of " +
                        base.name + "'s ESC, extended by half of it at both ends");
}

void read_commands(const Measurements& table, const plant::Vehicle& base, FlightLog& log,
                   std::vector<std::string>& assumptions) {
  const int shares = motors(table, Quantity::kMotorCommand);
  const int pulses = motors(table, Quantity::kMotorPulse);
  if (shares > 0 && pulses > 0)
    throw ConfigError(table.file(), 1, "header",
                      "has commands and pulse widths of motors, must have one of them");
  log.rotor_count = std::max(shares, pulses);
  if (log.rotor_count == 0) (void)table.column(Quantity::kMotorCommand);
  log.command.assign(table.row_count(), plant::PerRotor{});
  for (int i = 0; i < log.rotor_count; ++i) {
    const std::vector<double>& column =
        table.column((shares > 0 ? Quantity::kMotorCommand : Quantity::kMotorPulse) + i);
    for (std::size_t row = 0; row < column.size(); ++row) {
      if (shares == 0) require_pulse(table, row, Quantity::kMotorPulse + i, base);
      const double command =
          shares > 0 ? column[row] : plant::throttle_from_pulse_width(base.esc, column[row]);
      if (!(command >= 0.0 && command <= 1.0)) {
        throw ConfigError(table.file(), table.line(row), table.header(Quantity::kMotorCommand + i),
                          "is " + std::to_string(command) + " of full command, must be between 0 and 1");
      }
      log.command[row][static_cast<std::size_t>(i)] = command;
    }
  }
  log.running.assign(table.row_count(), 0);
  const bool has_running = table.has(Quantity::kRunning);
  for (std::size_t row = 0; row < log.running.size(); ++row) {
    const plant::PerRotor& command = log.command[row];
    log.running[row] = has_running
                           ? table.column(Quantity::kRunning)[row] != 0.0
                           : std::any_of(command.begin(), command.end(), [](double c) { return c > 0.0; });
  }
  if (!has_running)
    assumptions.emplace_back(
        "rotors are taken as off where all commands are 0, because there is no column running");
}

void read_rotor_speeds(const Measurements& table, FlightLog& log) {
  const int count = motors(table, Quantity::kMotorSpeed);
  if (count == 0) return;
  if (count != log.rotor_count) {
    throw ConfigError(table.file(), 1, "header",
                      "has speeds of " + std::to_string(count) + " rotors and commands of " +
                          std::to_string(log.rotor_count) + ", must have the same number of both");
  }
  log.rotor_speeds.assign(table.row_count(), plant::PerRotor{});
  for (int i = 0; i < count; ++i) {
    const std::vector<double>& column = table.column(Quantity::kMotorSpeed + i);
    for (std::size_t row = 0; row < column.size(); ++row)
      log.rotor_speeds[row][static_cast<std::size_t>(i)] = column[row];
  }
}

void read_poses(const Measurements& table, FlightLog& log) {
  if (!table.has(Quantity::kPoseTime) && !table.has(Quantity::kPositionX)) return;
  std::vector<Quantity> columns;
  columns.reserve(7);
  for (int i = 0; i < 3; ++i) columns.push_back(Quantity::kPositionX + i);
  for (int i = 0; i < 4; ++i) columns.push_back(Quantity::kOrientationW + i);
  const std::optional<bool> ned = has_first_ending(table, columns, "_ned", "_enu");
  if (!ned) {
    throw ConfigError(table.file(), 1, "header",
                      "does not name the frame of its poses: end position_x and the like in _ned or _enu, "
                      "orientation_w and the like in "
                      "_ned_from_frd or _enu_from_flu");
  }
  const std::vector<double>& time = table.column(Quantity::kPoseTime);
  const std::vector<Eigen::Vector3d> position = vectors(table, Quantity::kPositionX);
  const Eigen::Quaterniond ned_from_enu(0.0, std::sqrt(0.5), std::sqrt(0.5), 0.0);
  const Eigen::Quaterniond flu_from_frd(0.0, 1.0, 0.0, 0.0);
  for (std::size_t row = 0; row < time.size(); ++row) {
    if (!log.poses.empty() && time[row] <= log.poses.back().time_s) continue;
    Eigen::Quaterniond q(
        table.column(Quantity::kOrientationW)[row], table.column(Quantity::kOrientationX)[row],
        table.column(Quantity::kOrientationY)[row], table.column(Quantity::kOrientationZ)[row]);
    if (std::abs(q.norm() - 1.0) > 0.01) {
      throw ConfigError(table.file(), table.line(row), "orientation",
                        "has the length " + std::to_string(q.norm()) + ", must be 1");
    }
    q.normalize();
    const Eigen::Vector3d& p = position[row];
    log.poses.push_back(*ned
                            ? FlightPose{time[row], p, q}
                            : FlightPose{time[row], {p.y(), p.x(), -p.z()}, ned_from_enu * q * flu_from_frd});
  }
}

// Refuses the table of `swiftlet log csv`, which has neither specific forces nor all samples.
void refuse_telemetry(const std::string& text, const std::string& file) {
  if (io::is_flight_csv(io::first_csv_line(text, file))) {
    throw ConfigError(
        file, 1, "header",
        "is that of the telemetry of a flight; an identification needs the flight.mcap of its record");
  }
}

FlightLog recorded_log(const fs::path& path, BodyAxes axes, const std::string& vehicle) {
  const mcap::Reader file(path.string());
  if (axes == BodyAxes::kFlu)
    throw ConfigError(path.string(), 0, "", "has _frd axes, but --axes names others");
  const std::string name = record::recorded_vehicle(file, vehicle);
  FlightLog log = flight_log_of(record::read_flight(file, name));
  if (log.size() == 0)
    throw ConfigError(path.string(), 0, "/" + name,
                      "has no IMU samples with actuator commands, which an identification needs");
  log.name = path.string();
  return log;
}

}  // namespace

FlightLog flight_log_of(const record::Flight& flight) {
  FlightLog log;
  Newest commands(flight.commands);
  Newest batteries(flight.batteries);
  Newest speeds(flight.rotor_speeds);
  for (const plant::ImuSample& imu : flight.imu) {
    const plant::ActuatorCommand* const command = commands.at(imu.stamp_ns);
    const plant::BatterySample* const battery = batteries.at(imu.stamp_ns);
    const plant::RotorSpeedSample* const speed = speeds.at(imu.stamp_ns);
    if (command == nullptr || (battery == nullptr && !batteries.none()) ||
        (speed == nullptr && !speeds.none()))
      continue;
    log.time_s.push_back(math::seconds(imu.stamp_ns));
    log.specific_force_frd.push_back(imu.specific_force_frd);
    log.body_rates_frd.push_back(imu.body_rates_frd);
    log.command.push_back(command->throttle);
    log.running.push_back(command->rotor_state == plant::RotorState::kRunning ? 1 : 0);
    log.rotor_count = std::max(log.rotor_count, command->rotor_count);
    if (battery != nullptr)
      log.supply_voltage_v.push_back(voltage_at(*battery, batteries.following(), imu.stamp_ns));
    if (speed != nullptr) log.rotor_speeds.push_back(speed->speeds);
  }
  for (const plant::PoseSample& pose : flight.poses) {
    if (pose.tracked)
      log.poses.push_back({math::seconds(pose.stamp_ns), pose.position_ned, pose.q_ned_from_frd});
  }
  return log;
}

ReadFlightLog read_flight_log(const fs::path& path, const plant::Vehicle& base, BodyAxes axes,
                              const std::string& vehicle) {
  const record::FlightFile from = record::flight_file(path);
  const fs::path& file = from.file;
  if (record::is_mcap(file)) return {recorded_log(file, axes, vehicle.empty() ? from.vehicle : vehicle), {}};
  const std::string text = read_unpacked(file.string());
  refuse_telemetry(text, file.string());
  const Measurements table = io::parse_measurements(text, file.string(), flight_quantities());
  ReadFlightLog out;
  FlightLog& log = out.log;
  log.name = file.string();
  log.time_s = table.column(Quantity::kTime);
  for (std::size_t row = 1; row < log.time_s.size(); ++row) {
    const double step = log.time_s[row] - log.time_s[row - 1];
    if (step > 0.0 && step < kLongestTimeGap) continue;
    throw ConfigError(
        file.string(), table.line(row), table.header(Quantity::kTime),
        "is " + std::to_string(step) + " s after the previous row, must be above 0 and below 3600 s");
  }
  log.specific_force_frd = vectors(table, Quantity::kSpecificForceX);
  log.body_rates_frd = vectors(table, Quantity::kBodyRateX);
  if (!is_frd(table, log.specific_force_frd, axes, out.assumptions)) {
    const Eigen::Vector3d frd_from_flu(1.0, -1.0, -1.0);
    for (Eigen::Vector3d& force : log.specific_force_frd) force = force.cwiseProduct(frd_from_flu);
    for (Eigen::Vector3d& rate : log.body_rates_frd) rate = rate.cwiseProduct(frd_from_flu);
  }
  read_commands(table, base, log, out.assumptions);
  if (table.has(Quantity::kSupplyVoltage)) log.supply_voltage_v = table.column(Quantity::kSupplyVoltage);
  read_rotor_speeds(table, log);
  read_poses(table, log);
  return out;
}

}  // namespace swiftlet::analysis

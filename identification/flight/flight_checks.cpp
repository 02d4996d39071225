#include "swiftlet/identification/flight/flight_checks.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/fitting/checks.hpp"
#include "swiftlet/identification/fitting/limits.hpp"
#include "swiftlet/identification/flight/flight_series.hpp"

namespace swiftlet::identification {
namespace {

using Eigen::Vector3d;

constexpr double kLeastWeight = 0.5;  // of the median specific force, over g
constexpr double kMostWeight = 2.0;
constexpr double kMostOfMotors = 3.0;      // of rotor speeds over those of the motors, and its inverse
constexpr double kMoved = 0.15;            // m/s, least RMS change of velocity in a segment to compare
constexpr double kLeastCorrelation = 0.5;  // of the changes of velocity
constexpr double kMostSpeedRatio = 2.0;    // of their ratio, and its inverse
constexpr double kLeastPeriodS = 2e-5;     // s, of the IMU

template <typename Value>
std::vector<double> column(const Rows& rows, const Value& value) {
  std::vector<double> out;
  out.reserve(rows.size());
  for (std::size_t row = rows.first; row < rows.last; ++row) out.push_back(value(row));
  return out;
}

void require_change(const std::vector<double>& values, const std::string& name, const char* unit) {
  if (std::any_of(values.begin(), values.end(), [&](double value) { return value != values.front(); }))
    return;
  throw BadData(name + ": is " + format_number(values.front()) + " " + unit +
                " all through the flight, must vary");
}

void require_speed_gains_match(const std::vector<double>& gained, const std::vector<double>& by_force,
                               const char* direction) {
  const Comparison found = compared(gained, by_force);
  if (found.spread < kMoved) return;
  if (found.correlation < kLeastCorrelation) {
    throw BadData(std::string("positions: ") + direction +
                  " velocity disagrees with the specific force (correlation of their changes " +
                  format_number(found.correlation) + ", must be above " + format_number(kLeastCorrelation) +
                  "); are the frames of poses and IMU right?");
  }
  if (found.ratio > kMostSpeedRatio || found.ratio < 1.0 / kMostSpeedRatio) {
    throw BadData(std::string("positions: ") + direction + " velocity changes by " +
                  format_number(found.ratio) + " times as much as the specific force gives, must be " +
                  format_number(1.0 / kMostSpeedRatio) + " to " + format_number(kMostSpeedRatio) +
                  "; is the unit right?");
  }
}

}  // namespace

void require_times(const FlightLog& log) {
  std::vector<double> periods;
  for (std::size_t row = 1; row < log.size(); ++row) periods.push_back(log.time_s[row] - log.time_s[row - 1]);
  if (periods.empty()) throw BadData("has one row, must contain a flight");
  const double period_s = median(periods);
  if (period_s > kLeastPeriodS && period_s <= kLongestRowGapS) return;
  throw BadData("time: the median sample period is " + format_number(period_s) + " s, must be " +
                format_number(kLeastPeriodS) + " to " + format_number(kLongestRowGapS) +
                " s; is the unit right?");
}

void require_readings(const FlightLog& log, const Rows& flight) {
  const std::string of_axis[3] = {" x", " y", " z"};
  for (int axis = 0; axis < 3; ++axis) {
    require_change(column(flight, [&](std::size_t row) { return log.specific_force_frd[row][axis]; }),
                   "specific force" + of_axis[axis], "m/s^2");
    require_change(column(flight, [&](std::size_t row) { return log.body_rates_frd[row][axis]; }),
                   "body rate" + of_axis[axis], "rad/s");
  }
  const std::vector<double> force =
      column(flight, [&](std::size_t row) { return log.specific_force_frd[row].norm(); });
  require_median_between({"specific force", "m/s^2", force}, kLeastWeight * plant::kGravity,
                         kMostWeight * plant::kGravity, "a flying vehicle carries its weight");
  for (std::size_t rotor = 0; rotor < static_cast<std::size_t>(log.rotor_count); ++rotor) {
    const std::string number = std::to_string(rotor + 1);
    require_change(column(flight, [&](std::size_t row) { return log.command[row][rotor]; }),
                   "command of motor " + number, "of full command");
    if (log.rotor_speeds.empty()) continue;
    const std::vector<double> speeds =
        column(flight, [&](std::size_t row) { return log.rotor_speeds[row][rotor]; });
    require_change(speeds, "speed of rotor " + number, "rad/s");
    require_median_between({"rotor speed", "rad/s", speeds}, kLeastRotorSpeed, kMostRotorSpeed,
                           "no rotor flies a vehicle slower or faster");
  }
  if (log.supply_voltage_v.empty()) return;
  const std::vector<double> supply =
      column(flight, [&](std::size_t row) { return log.supply_voltage_v[row]; });
  require_median_between({"supply voltage", "V", supply}, kLeastSupplyVoltage, kMostSupplyVoltage,
                         "no vehicle flies on less or more");
}

void require_speeds_match_motors(const FlightSeries& series, const plant::Vehicle& base) {
  const auto mean = [](const plant::PerRotor& speeds, int count) {
    double sum = 0.0;
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) sum += speeds[i] / count;
    return sum;
  };
  const FlightLog& log = *series.log;
  const Rows& flight = series.window.flight;
  const double steady = median(
      column(flight, [&](std::size_t row) { return mean(series.steady_speeds[row], log.rotor_count); }));
  const std::string at = " at these commands and this voltage";
  if (steady < kLeastRotorSpeed || steady > kMostRotorSpeed) {
    throw BadData("rotors: the motors of " + base.name + " reach " + format_number(steady) + " rad/s" + at +
                  ", must be " + format_number(kLeastRotorSpeed) + " to " + format_number(kMostRotorSpeed) +
                  "; are the units and the base vehicle right?");
  }
  if (log.rotor_speeds.empty()) return;
  const double ratio =
      median(column(flight, [&](std::size_t row) { return mean(log.rotor_speeds[row], log.rotor_count); })) /
      steady;
  if (ratio < kMostOfMotors && ratio > 1.0 / kMostOfMotors) return;
  throw BadData("rotor speeds: are " + format_number(ratio) + " times what the motors of " + base.name +
                " reach" + at + ", must be " + format_number(1.0 / kMostOfMotors) + " to " +
                format_number(kMostOfMotors) + "; are the units and the base vehicle right?");
}

void require_positions_match_force(const FlightSeries& series) {
  const FlightLog& log = *series.log;
  const Vector3d gravity_ned(0.0, 0.0, plant::kGravity);
  std::vector<double> gained[3];
  std::vector<double> by_force[3];
  for (const Rows& segment : series.segments) {
    Vector3d by_force_sum = Vector3d::Zero();
    for (std::size_t row = segment.first + 1; row < segment.last; ++row) {
      const double h = log.time_s[row] - log.time_s[row - 1];
      by_force_sum += h * (series.attitude[row] * log.specific_force_frd[row] + gravity_ned);
    }
    const Vector3d speed = series.velocity_ned[segment.last - 1] - series.velocity_ned[segment.first];
    for (int axis = 0; axis < 3; ++axis) {
      gained[axis].push_back(speed[axis]);
      by_force[axis].push_back(by_force_sum[axis]);
    }
  }
  if (gained[0].empty()) return;
  require_speed_gains_match(gained[0], by_force[0], "north");
  require_speed_gains_match(gained[1], by_force[1], "east");
  require_speed_gains_match(gained[2], by_force[2], "down");
}

}  // namespace swiftlet::identification

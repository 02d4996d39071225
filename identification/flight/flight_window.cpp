#include "swiftlet/identification/flight/flight_window.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kCarrying = 0.9;  // of the median command: enough to lift the vehicle
constexpr double kSmoothingS = 0.05;
constexpr double kAfterLiftS = 0.3;  // until the vehicle is clear of the ground
constexpr double kBeforeImpactS = 0.3;
constexpr double kNotableS = 1.0;       // s, shorter unused parts of the flight are not reported
constexpr double kLongestPauseS = 1.0;  // s, longest pause of the rotors in flight (free fall)

std::size_t row_at(const FlightLog& log, double time_s) {
  return static_cast<std::size_t>(std::lower_bound(log.time_s.begin(), log.time_s.end(), time_s) -
                                  log.time_s.begin());
}

// The longest time with running rotors, including short pauses.
Rows running_rows(const FlightLog& log) {
  Rows best;
  Rows now;
  bool inside = false;
  for (std::size_t i = 0; i < log.size(); ++i) {
    if (log.running[i] == 0) continue;
    if (inside && log.time_s[i] - log.time_s[now.last - 1] > kLongestPauseS) inside = false;
    if (!inside) now = {i, i};
    inside = true;
    now.last = i + 1;
    if (now.size() > best.size()) best = now;
  }
  return best;
}

// Mean command of the rotors, low-pass filtered.
std::vector<double> smoothed_commands(const FlightLog& log, const Rows& rows) {
  std::vector<double> out(rows.size(), 0.0);
  double smoothed = 0.0;
  for (std::size_t i = 1; i < out.size(); ++i) {
    const std::size_t row = rows.first + i;
    double mean = 0.0;
    for (int rotor = 0; rotor < log.rotor_count; ++rotor)
      mean += log.command[row][static_cast<std::size_t>(rotor)] / log.rotor_count;
    const double h = log.time_s[row] - log.time_s[row - 1];
    out[i] = smoothed += std::min(h / kSmoothingS, 1.0) * (mean - smoothed);
  }
  return out;
}

// From the first to the last command that carries the vehicle. Assumes flight for most of the time.
Rows carried(const FlightLog& log, const Rows& running) {
  const std::vector<double> commands = smoothed_commands(log, running);
  std::vector<double> sorted = commands;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  const double carrying = kCarrying * *middle;
  const auto carries = [&](double command) { return command >= carrying; };
  const auto first = std::find_if(commands.begin(), commands.end(), carries);
  const auto last = std::find_if(commands.rbegin(), commands.rend(), carries);
  const auto row = [&](std::ptrdiff_t i) { return running.first + static_cast<std::size_t>(i); };
  const Rows rows{row_at(log, log.time_s[row(first - commands.begin())] + kAfterLiftS),
                  row_at(log, log.time_s[row(commands.rend() - last - 1)] - kLandingS)};
  return {rows.first, std::max(rows.first, rows.last)};
}

Rows above_ground(const FlightLog& log, const Rows& running) {
  const double start_s = log.time_s[running.first];
  const auto first = std::lower_bound(log.poses.begin(), log.poses.end(), start_s,
                                      [](const FlightPose& pose, double t) { return pose.time_s < t; });
  if (first == log.poses.end()) return {running.last, running.last};
  const double floor = first->position_ned.z();
  Rows rows{running.last, running.last};
  for (auto pose = first; pose != log.poses.end(); ++pose) {
    if (floor - pose->position_ned.z() < kAirborneHeightM) continue;
    const std::size_t row = row_at(log, pose->time_s);
    if (row >= running.last) break;
    rows.first = std::min(rows.first, row);
    rows.last = row + 1;
  }
  rows.last = std::max(rows.first, rows.last);
  return rows;
}

std::string seconds(double time_s) { return fmt::format("{:.2f}", time_s); }

Rows airborne(const FlightLog& log, const Rows& running) {
  return log.poses.empty() ? carried(log, running) : above_ground(log, running);
}

// Rejects poses of another clock and poses that never leave the ground.
void require_flight_in_poses(const FlightLog& log, const Rows& running) {
  if (log.poses.empty()) return;
  const double from_s = log.time_s[running.first];
  const double to_s = log.time_s[running.last - 1];
  if (log.poses.back().time_s < from_s || log.poses.front().time_s > to_s) {
    throw BadData("has poses from " + seconds(log.poses.front().time_s) + " to " +
                  seconds(log.poses.back().time_s) + " s and rotors that run from " + seconds(from_s) +
                  " to " + seconds(to_s) + " s; must have both on one clock");
  }
  if (above_ground(log, running).size() == 0) {
    throw BadData(
        "has no pose more than " + format_number(kAirborneHeightM) +
        " m above the point where the rotors started, must contain a flight; are the unit and the frame "
        "of positions right?");
  }
}

// Reports the time with running rotors that is not part of `running`, and the time after the last pose.
void warn_of_omitted(const FlightLog& log, const Rows& running, FlightWindow& out) {
  double elsewhere_s = 0.0;
  for (std::size_t row = 1; row < log.size(); ++row) {
    const bool taken = row >= running.first && row < running.last;
    const double h = log.time_s[row] - log.time_s[row - 1];
    if (!taken && log.running[row] != 0 && log.running[row - 1] != 0 && h < kLongestPauseS) elsewhere_s += h;
  }
  if (elsewhere_s > kNotableS) {
    out.left_out.push_back("the flight is searched from " + seconds(log.time_s[running.first]) + " to " +
                           seconds(log.time_s[running.last - 1]) +
                           " s, the longest time without a pause or a gap of more than " +
                           format_number(kLongestPauseS) + " s; the rotors ran for another " +
                           format_number(elsewhere_s) + " s, which --from and --until can select");
  }
  if (log.poses.empty()) return;
  const double unseen_s = log.time_s[running.last - 1] - log.poses.back().time_s;
  if (unseen_s > kNotableS) {
    out.left_out.push_back("poses end at " + seconds(log.poses.back().time_s) + " s; the rotors ran on for " +
                           format_number(unseen_s) + " s, which are not used");
  }
}

}  // namespace

FlightWindow find_flight(const FlightLog& log, const FlightBounds& bounds) {
  const Rows running = running_rows(log);
  if (running.size() == 0) throw BadData("the rotors never ran");
  const bool all_known = bounds.from_s && bounds.until_s;
  if (!all_known) require_flight_in_poses(log, running);
  FlightWindow out;
  out.flight = airborne(log, running);
  if (!all_known) warn_of_omitted(log, running, out);
  if (bounds.from_s) out.flight.first = row_at(log, *bounds.from_s);
  if (bounds.until_s) out.flight.last = row_at(log, *bounds.until_s);
  double impact_s = 0.0;
  for (std::size_t i = out.flight.first; i < out.flight.last; ++i) {
    if (log.specific_force_frd[i].norm() < kImpact) continue;
    out.flight.last = row_at(log, log.time_s[i] - kBeforeImpactS);
    out.ends_in_impact = true;
    impact_s = log.time_s[i];
  }
  const double length_s = out.flight.first < out.flight.last
                              ? log.time_s[out.flight.last - 1] - log.time_s[out.flight.first]
                              : 0.0;
  if (length_s < kShortestFlightS) {
    throw BadData("has " + format_number(length_s) + " s of flight, must have at least " +
                  format_number(kShortestFlightS) + " s" +
                  (out.ends_in_impact
                       ? "; a specific force of more than " + format_number(kImpact) + " m/s^2 at " +
                             seconds(impact_s) + " s ends it: is the unit right?"
                       : ""));
  }
  return out;
}

}  // namespace swiftlet::identification

#include "identification/flight_window.hpp"

#include <algorithm>
#include <cmath>

#include "identification/estimate.hpp"
#include "plant/model/vehicle.hpp"

namespace swiftlet::identification {
namespace {

constexpr double kLift = 1.5;  // m/s^2 by which the specific force differs from g, smoothed, in a lift-off
constexpr double kSmoothingS = 0.05;
constexpr double kAfterLiftS = 0.3;  // until the legs are well off the ground
constexpr double kBeforeBlowS = 0.3;
constexpr double kLongestPauseS =
    1.0;  // of rotors without command that is still flight: a fall between two pushes

std::size_t row_at(const FlightLog& log, double time_s) {
  return static_cast<std::size_t>(std::lower_bound(log.time_s.begin(), log.time_s.end(), time_s) -
                                  log.time_s.begin());
}

// The longest stretch of running rotors, short pauses included.
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

// Where the vehicle is well off the ground it rose from, by the specific force alone.
std::size_t lift_off(const FlightLog& log, const Rows& running) {
  double smoothed = plant::kGravity;
  for (std::size_t i = running.first + 1; i < running.last; ++i) {
    const double h = log.time_s[i] - log.time_s[i - 1];
    smoothed += std::min(h / kSmoothingS, 1.0) * (log.specific_force_frd[i].norm() - smoothed);
    if (std::abs(smoothed - plant::kGravity) > kLift) return row_at(log, log.time_s[i] + kAfterLiftS);
  }
  return running.last;
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

Rows airborne(const FlightLog& log, const Rows& running) {
  if (!log.poses.empty()) return above_ground(log, running);
  const Rows rows{lift_off(log, running), row_at(log, log.time_s[running.last - 1] - kLandingS)};
  return {std::min(rows.first, rows.last), rows.last};
}

}  // namespace

FlightWindow find_flight(const FlightLog& log, const FlightBounds& bounds) {
  const Rows running = running_rows(log);
  if (running.size() == 0) throw BadData("the rotors never ran");
  FlightWindow out;
  out.flight = airborne(log, running);
  if (bounds.from_s) out.flight.first = row_at(log, *bounds.from_s);
  if (bounds.until_s) out.flight.last = row_at(log, *bounds.until_s);
  for (std::size_t i = out.flight.first; i < out.flight.last; ++i) {
    if (log.specific_force_frd[i].norm() < kBlow) continue;
    out.flight.last = row_at(log, log.time_s[i] - kBeforeBlowS);
    out.ends_in_a_blow = true;
  }
  const double length_s = out.flight.first < out.flight.last
                              ? log.time_s[out.flight.last - 1] - log.time_s[out.flight.first]
                              : 0.0;
  if (length_s < kShortestFlightS) {
    throw BadData("holds " + shown(length_s) + " s of flight, must hold at least " + shown(kShortestFlightS) +
                  " s");
  }
  return out;
}

}  // namespace swiftlet::identification

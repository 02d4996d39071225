// How time runs along a path: with the vehicle's, not at all, or smoothly from one to the other. What is
// slowed down and brought to rest by its clock stays exactly on its path, wherever that leads.
#pragma once

#include <cstdint>
#include <type_traits>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

// An instant of a path's own time, and how that runs: the first four derivatives by the vehicle's time.
struct PathTime {
  std::int64_t at_ns = 0;
  double rate = 1.0;          // 1: as the vehicle's; 0: it stands
  double acceleration = 0.0;  // 1/s
  double jerk = 0.0;          // 1/s^2
  double snap = 0.0;          // 1/s^3
};

// Plain data, so that another process can go on with it where this one stopped.
struct TimeScaling {
  bool runs = true;            // once the change is over
  std::int64_t change_ns = 0;  // when the change began, vehicle's time
  std::int64_t from_ns = 0;    // and what the path's time was then
  double change_s = 0.0;       // how long it takes; 0: there is none
  Polynomial rate{};           // of the path's time, by s since change_ns, during the change

  // From now on towards running or standing: a quintic of the rate, which begins as it is and ends steadily.
  void turn(bool to_running, double duration_s, std::int64_t now_ns);
  // Stands at this time of the path.
  static TimeScaling standing_at(std::int64_t path_ns, std::int64_t now_ns);

  PathTime at(std::int64_t now_ns) const {
    return is_vehicle_time() ? PathTime{now_ns} : at_own_pace(now_ns);
  }
  bool is_changing(std::int64_t now_ns) const { return change_s > 0.0 && now_ns < change_end_ns(); }
  bool is_vehicle_time() const { return runs && change_s == 0.0 && from_ns == change_ns; }

 private:
  std::int64_t change_end_ns() const;
  PathTime at_own_pace(std::int64_t now_ns) const;
};
static_assert(std::is_trivially_copyable_v<TimeScaling>);

// The shortest change between running and standing in which a motion at this speed (m/s, >= 0) is slowed by
// at most acceleration and jerk (m/s^2, m/s^3, > 0): 15/8 v/T and 10/sqrt(3) v/T^2. At least
// min_duration_s.
double clock_change_duration(double speed, double acceleration, double jerk, double min_duration_s);

// Of what has `reference` at a time of the path's own: what it has by the vehicle's time, by the chain rule.
Reference time_scaled(const Reference& reference, const PathTime& time);

}  // namespace swiftlet::control

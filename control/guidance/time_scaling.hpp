// Time scaling of a path: path time runs as vehicle time, stands still, or changes smoothly between the two.
// A vehicle that is slowed and stopped this way stays exactly on its path, whatever its shape.
#pragma once

#include <cstdint>
#include <type_traits>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

// A path time and its first four derivatives with respect to vehicle time.
struct PathTime {
  std::int64_t at_ns = 0;
  double rate = 1.0;          // 1: as vehicle time; 0: stopped
  double acceleration = 0.0;  // 1/s
  double jerk = 0.0;          // 1/s^2
  double snap = 0.0;          // 1/s^3
};

// Plain data, so that another process can take it over.
struct TimeScaling {
  bool runs = true;            // state after the change
  std::int64_t change_ns = 0;  // start of the change, vehicle time
  std::int64_t from_ns = 0;    // path time at change_ns
  double change_s = 0.0;       // duration of the change; 0: no change
  Polynomial rate{};           // rate of path time during the change, over s since change_ns

  // Starts a change towards running or stopped: a quintic of the rate that is continuous at its start and
  // end.
  void turn(bool to_running, double duration_s, std::int64_t now_ns);
  // Path time stopped at path_ns.
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

// The shortest change between running and stopped that slows a motion at this speed (m/s, >= 0) within
// acceleration and jerk (m/s^2, m/s^3, > 0): their peaks are 15/8 v/T and 10/sqrt(3) v/T^2. At least
// min_duration_s.
double clock_change_duration(double speed, double acceleration, double jerk, double min_duration_s);

// The reference with respect to vehicle time, from that with respect to path time, by the chain rule.
Reference time_scaled(const Reference& reference, const PathTime& time);

}  // namespace swiftlet::control

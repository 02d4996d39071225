#include "swiftlet/control/planning/limited_jerk.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace swiftlet::control {
namespace {

constexpr double kLeastDistance_m = 1e-6;
constexpr double kLeastTurn_rad = 1e-6;
constexpr double kLeastPhase_s = 1e-9;

// Durations of the profile over a distance d from rest to rest.
struct DoubleS {
  double jerk_s = 0.0;    // of each of the four pieces with jerk
  double steady_s = 0.0;  // at full acceleration, and again at full deceleration
  double cruise_s = 0.0;
};

DoubleS double_s(double d, double v, double a, double j) {
  DoubleS t;
  t.jerk_s = v * j >= a * a ? a / j : std::sqrt(v / j);
  const double ramp_s = v * j >= a * a ? t.jerk_s + v / a : 2.0 * t.jerk_s;
  t.cruise_s = d / v - ramp_s;
  if (t.cruise_s < 0.0) {  // full speed is not reached
    t.cruise_s = 0.0;
    if (d >= 2.0 * a * a * a / (j * j)) {
      t.jerk_s = a / j;
      t.steady_s = -1.5 * t.jerk_s + std::sqrt(0.25 * t.jerk_s * t.jerk_s + d / a);
    } else {  // nor is full acceleration
      t.jerk_s = std::cbrt(d / (2.0 * j));
      t.steady_s = 0.0;
    }
  } else {
    t.steady_s = ramp_s - 2.0 * t.jerk_s;
  }
  return t;
}

}  // namespace

std::vector<PolynomialSegment> limited_jerk_leg(const Eigen::Vector3d& from_ned, double from_yaw,
                                                const Eigen::Vector3d& to_ned, double to_yaw,
                                                const MotionLimits& limits) {
  const double distance = (to_ned - from_ned).norm();
  const double turn = std::abs(to_yaw - from_yaw);
  if (distance < kLeastDistance_m) {
    if (turn < kLeastTurn_rad) return {};
    return {minimum_jerk(from_ned, from_yaw, from_ned, to_yaw, 15.0 / 8.0 * turn / limits.yaw_rate)};
  }
  const double speed =
      turn < kLeastTurn_rad ? limits.speed : std::min(limits.speed, limits.yaw_rate * distance / turn);
  const DoubleS t = double_s(distance, speed, limits.acceleration, limits.jerk);
  const double j = limits.jerk;
  const std::array<std::pair<double, double>, 7> pieces = {{{j, t.jerk_s},
                                                            {0.0, t.steady_s},
                                                            {-j, t.jerk_s},
                                                            {0.0, t.cruise_s},
                                                            {-j, t.jerk_s},
                                                            {0.0, t.steady_s},
                                                            {j, t.jerk_s}}};
  const Eigen::Vector3d direction = (to_ned - from_ned) / distance;
  const double yaw_per_m = (to_yaw - from_yaw) / distance;
  std::vector<PolynomialSegment> segments;
  double s = 0.0, v = 0.0, a = 0.0;  // distance, speed and acceleration along the leg
  for (const auto& [jerk, duration_s] : pieces) {
    if (duration_s < kLeastPhase_s) continue;
    const auto axis = [&, jerk = jerk](double from, double per_m) {
      return Polynomial{from + per_m * s, per_m * v, per_m * a / 2.0, per_m * jerk / 6.0};
    };
    PolynomialSegment& segment = segments.emplace_back();
    segment.duration_s = duration_s;
    segment.x = axis(from_ned.x(), direction.x());
    segment.y = axis(from_ned.y(), direction.y());
    segment.z = axis(from_ned.z(), direction.z());
    segment.yaw = axis(from_yaw, yaw_per_m);
    s += duration_s * (v + duration_s * (a / 2.0 + duration_s * jerk / 6.0));
    v += duration_s * (a + duration_s * jerk / 2.0);
    a += duration_s * jerk;
  }
  return segments;
}

}  // namespace swiftlet::control

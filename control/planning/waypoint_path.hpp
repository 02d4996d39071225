// Plans a path through waypoints from rest to rest under limits of speed, acceleration and jerk. By default
// it is a spline of minimum snap or jerk that passes the waypoints without stopping.
#pragma once

#include <cstddef>
#include <vector>

#include "swiftlet/control/planning/limited_jerk.hpp"
#include "swiftlet/control/planning/spline.hpp"

namespace swiftlet::control {

struct PathPoint {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  double yaw_rad = 0.0;
  bool stop = false;  // stop here; the first and the last point are stops anyway
};

enum class LegShape {
  kFree,      // as the spline goes
  kCorridor,  // without a stop, within corridor_m of the straight line between its points
  kStraight,  // exactly on that line, from rest to rest (limited_jerk.hpp)
};

struct Leg {
  LegShape shape = LegShape::kFree;
  double corridor_m = 0.1;  // half width of kCorridor, 1 mm or more
};

struct WaypointPath {
  std::vector<PathPoint> points;  // two or more
  std::vector<Leg> legs;          // one fewer than points, or empty: all kFree
  Smoothness smoothness = Smoothness::kMinimumSnap;
  MotionLimits limits;
};

struct PlannedPath {
  std::vector<PolynomialSegment> segments;  // at most kMaxTrajectorySegments
  std::vector<std::size_t> leg_begins;      // index of the first segment of each leg
  double duration_s = 0.0;
};

// Plans the path. The limits hold everywhere on it, by upper bounds of the polynomials, and between any two
// stops one of them is reached. A point closer than 0.1 mm to the one before only turns the vehicle. Throws
// std::invalid_argument with a sentence if the path cannot be planned.
PlannedPath plan(const WaypointPath& path);

// Greatest use of each limit in a segment: 1 is at the limit. Upper bounds that hold everywhere, to 1e-6.
struct LimitUse {
  double speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
  double yaw_rate = 0.0;

  // The factor by which all durations of a path must grow for its limits to hold.
  double stretch() const;
};
LimitUse limit_use(const PolynomialSegment& segment, const MotionLimits& limits);

}  // namespace swiftlet::control

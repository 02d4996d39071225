// A path through waypoints from rest to rest, planned under limits of speed, acceleration and jerk: where
// nothing else is asked, a spline of least snap or jerk that flies through them without stopping.
#pragma once

#include <cstddef>
#include <vector>

#include "swiftlet/control/planning/limited_jerk.hpp"
#include "swiftlet/control/planning/spline.hpp"

namespace swiftlet::control {

struct PathPoint {
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  double yaw_rad = 0.0;
  bool stop = false;  // come to rest here; the first and the last point are stops anyway
};

enum class LegShape {
  kFree,      // wherever the spline swings
  kCorridor,  // flown through, no further than corridor_m from the straight line between its points
  kStraight,  // exactly on that line, from rest to rest (limited_jerk.hpp)
};

struct Leg {
  LegShape shape = LegShape::kFree;
  double corridor_m = 0.1;  // kCorridor: half the width, 1 mm or more
};

struct WaypointPath {
  std::vector<PathPoint> points;  // two or more
  std::vector<Leg> legs;          // one less than the points, or empty: all free
  Smoothness smoothness = Smoothness::kMinimumSnap;
  MotionLimits limits;
};

struct PlannedPath {
  std::vector<PolynomialSegment> segments;  // at most kMaxTrajectorySegments
  std::vector<std::size_t> leg_begins;      // of each leg, the index of its first segment
  double duration_s = 0.0;
};

// The limits hold everywhere on it, as upper bounds of the polynomials show, and some of them is reached
// between any two stops. Points nearer than 0.1 mm to the one before are places to turn. Throws
// std::invalid_argument with a sentence for what cannot be planned.
PlannedPath plan(const WaypointPath& path);

// The extrema of one segment over the limits: 1 is at the limit. By bounds that hold everywhere, good to
// 1e-6.
struct LimitUse {
  double speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
  double yaw_rate = 0.0;

  // The factor by which the time must grow for all to hold, if it grows alike along a whole path.
  double stretch() const;
};
LimitUse limit_use(const PolynomialSegment& segment, const MotionLimits& limits);

}  // namespace swiftlet::control

#include "swiftlet/control/planning/waypoint_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "swiftlet/control/planning/bernstein.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kSamePlace_m = 1e-4;
constexpr double kLeastCorridor_m = 1e-3;
constexpr double kLeastDuration_s = 1e-3;
constexpr int kSmoothings = 12;
constexpr double kSmoothingExponent = 0.15;
constexpr int kBalancings = 24;
constexpr int kPatience = 6;                // rounds without gain before it ends
constexpr double kGain = 1e-3;              // least gain in the whole duration, relative
constexpr int kSamples = 6;                 // samples of a segment in each round
constexpr double kSlowingExponent = 0.5;    // change of a segment's duration with its limit use, above 1
constexpr double kHasteningExponent = 0.1;  // ... and below 1
constexpr int kMaxRefinements = 10;         // rounds of points added to keep a spline inside its corridors

[[noreturn]] void reject(const std::string& sentence) { throw std::invalid_argument(sentence); }

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

PositionYaw place_of(const PathPoint& point) {
  return {point.position_ned.x(), point.position_ned.y(), point.position_ned.z(), point.yaw_rad};
}

void check(const WaypointPath& path) {
  const auto above_zero = [](const char* what, double value) {
    if (!(value > 0.0) || !std::isfinite(value))
      reject(std::string("the limit of ") + what + " is " + number(value) + ", must be above 0");
  };
  above_zero("speed", path.limits.speed);
  above_zero("acceleration", path.limits.acceleration);
  above_zero("jerk", path.limits.jerk);
  above_zero("yaw rate", path.limits.yaw_rate);
  if (path.points.size() < 2)
    reject("the path has " + std::to_string(path.points.size()) + " points, must have at least 2");
  if (path.points.size() > kMaxTrajectorySegments + 1) {
    reject("the path has " + std::to_string(path.points.size()) + " points, at most " +
           std::to_string(kMaxTrajectorySegments + 1) + " fit");
  }
  if (!path.legs.empty() && path.legs.size() + 1 != path.points.size()) {
    reject("the path has " + std::to_string(path.legs.size()) + " legs between " +
           std::to_string(path.points.size()) + " points, must be one fewer than points");
  }
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    if (!place_of(path.points[i]).allFinite())
      reject("point " + std::to_string(i + 1) + ": a value is not a finite number");
  }
  for (std::size_t i = 0; i < path.legs.size(); ++i) {
    const Leg& leg = path.legs[i];
    if (leg.shape == LegShape::kCorridor && !(leg.corridor_m >= kLeastCorridor_m)) {
      reject("leg " + std::to_string(i + 1) + ": the corridor is " + number(leg.corridor_m) +
             " m, must be at least " + number(kLeastCorridor_m) + " m");
    }
  }
}

// The points of a spline between two stops. Points added for a corridor lie on the straight line of their
// leg.
struct Knots {
  std::vector<PositionYaw> places;
  std::vector<std::size_t> leg;  // of each segment; index from the start of the path
  std::vector<double> durations_s;
};

// Initial estimate of a leg's duration.
double first_duration(const PositionYaw& from, const PositionYaw& to, bool at_end,
                      const MotionLimits& limits) {
  const double distance = (to - from).head<3>().norm();
  const double turn = std::abs(to[3] - from[3]);
  const double passing = std::max(distance / limits.speed, turn / limits.yaw_rate);
  const double starting = at_end ? limits.speed / limits.acceleration / 2.0 : 0.0;
  const double slow = std::sqrt(2.0 * distance / limits.acceleration);
  return std::max({std::min(passing + starting, slow), passing, kLeastDuration_s});
}

// As limit_use(), but from samples.
LimitUse sampled_use(const PolynomialSegment& segment, const MotionLimits& limits) {
  LimitUse use;
  for (int i = 0; i <= kSamples; ++i) {
    const Reference at = evaluate(segment, segment.duration_s * i / kSamples);
    use.speed = std::max(use.speed, at.velocity_ned.squaredNorm());
    use.acceleration = std::max(use.acceleration, at.acceleration_ned.squaredNorm());
    use.jerk = std::max(use.jerk, at.jerk_ned.squaredNorm());
    use.yaw_rate = std::max(use.yaw_rate, std::abs(at.yaw_rate));
  }
  use.speed = std::sqrt(use.speed) / limits.speed;
  use.acceleration = std::sqrt(use.acceleration) / limits.acceleration;
  use.jerk = std::sqrt(use.jerk) / limits.jerk;
  use.yaw_rate /= limits.yaw_rate;
  return use;
}

double sum(const std::vector<double>& values) {
  double total = 0.0;
  for (const double value : values) total += value;
  return total;
}

// Minus the derivative of a segment's cost with respect to its duration, for optimal end derivatives: the
// Hamiltonian of the spline's variational problem, which is constant along the segment.
double hamiltonian(const PolynomialSegment& segment, Smoothness smoothness) {
  double sum = 0.0;
  for (const Polynomial* const axis : {&segment.x, &segment.y, &segment.z}) {
    std::array<double, kPolynomialCoefficients> d{};  // derivatives at its start
    double factorial = 1.0;
    for (std::size_t k = 1; k < d.size(); ++k) {
      factorial *= static_cast<double>(k);
      d[k] = factorial * (*axis)[k];
    }
    sum += smoothness == Smoothness::kMinimumSnap
               ? d[4] * d[4] - 2.0 * d[5] * d[3] + 2.0 * d[6] * d[2] - 2.0 * d[7] * d[1]
               : d[3] * d[3] - 2.0 * d[4] * d[2] + 2.0 * d[5] * d[1];
  }
  return sum;
}

// Moves the durations, at a constant sum, towards least cost: there the Hamiltonians of all segments are
// equal.
void smooth(Knots& knots, Smoothness smoothness) {
  for (int round = 0; round < kSmoothings; ++round) {
    const std::vector<PolynomialSegment> segments = spline(smoothness, knots.places, knots.durations_s);
    std::vector<double> share(segments.size());
    double weighted = 0.0;
    for (std::size_t i = 0; i < segments.size(); ++i) {
      share[i] = std::max(hamiltonian(segments[i], smoothness), 0.0);
      weighted += share[i] * knots.durations_s[i];
    }
    if (!(weighted > 0.0)) return;
    const double mean = weighted / sum(knots.durations_s);
    for (std::size_t i = 0; i < segments.size(); ++i)
      knots.durations_s[i] *= std::clamp(std::pow(share[i] / mean, kSmoothingExponent), 0.7, 1.5);
  }
}

// Moves time to the segments that use the limits most, while the whole gets shorter. The measure is the
// whole duration after stretching to the limits; from rest to rest, stretching changes nothing else.
void balance(Knots& knots, Smoothness smoothness, const MotionLimits& limits) {
  std::vector<double> durations = knots.durations_s;
  double best_s = std::numeric_limits<double>::infinity();
  int without_gain = 0;
  for (int round = 0; round < kBalancings && without_gain < kPatience; ++round) {
    const std::vector<PolynomialSegment> segments = spline(smoothness, knots.places, durations);
    std::vector<double> use(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) use[i] = sampled_use(segments[i], limits).stretch();
    const double stretch = *std::max_element(use.begin(), use.end());
    const double whole_s = stretch * sum(durations);
    without_gain = whole_s < (1.0 - kGain) * best_s ? 0 : without_gain + 1;
    if (whole_s < best_s) {
      best_s = whole_s;
      knots.durations_s = durations;
      for (double& duration : knots.durations_s) duration *= stretch;
    }
    for (std::size_t i = 0; i < durations.size(); ++i) {
      const double exponent = use[i] > 1.0 ? kSlowingExponent : kHasteningExponent;
      durations[i] *= std::clamp(std::pow(use[i], exponent), 0.5, 2.0);
    }
  }
}

// Stretches time by the factor.
void stretch(std::vector<PolynomialSegment>& segments, double factor) {
  for (PolynomialSegment& segment : segments) segment = stretched(segment, factor);
}

// Greatest distance of a segment from the straight line between its leg's points, including beyond its ends.
double distance_from_leg(const PolynomialSegment& segment, const Vector3d& from, const Vector3d& to) {
  const double length = (to - from).norm();
  const Vector3d along = (to - from) / length;
  const Vector3d across = along.unitOrthogonal();
  const Vector3d upright = along.cross(across);
  const std::array<Bernstein, 3> axes = {bernstein(segment.x, segment.duration_s),
                                         bernstein(segment.y, segment.duration_s),
                                         bernstein(segment.z, segment.duration_s)};
  const auto towards = [&](const Vector3d& direction) {
    return direction.x() * axes[0] + direction.y() * axes[1] + direction.z() * axes[2] -
           constant(direction.dot(from));
  };
  const Bernstein progress = towards(along);
  const double tolerance = kExtremumPrecision * kLeastCorridor_m;
  const double beside =
      maximum(squared_length(towards(across), towards(upright)), tolerance * tolerance).value;
  const double before = -minimum(progress, tolerance).value;
  const double beyond = maximum(progress, tolerance).value - length;
  return std::max({std::sqrt(std::max(beside, 0.0)) + tolerance, before, beyond});
}

// Adds a point in the middle of each segment that leaves its corridor. Returns true if it added one.
bool refine(Knots& knots, const std::vector<PolynomialSegment>& segments, const WaypointPath& path) {
  Knots finer;
  finer.places.push_back(knots.places.front());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::size_t leg = knots.leg[i];
    const bool kept = path.legs.empty() || path.legs[leg].shape != LegShape::kCorridor ||
                      distance_from_leg(segments[i], path.points[leg].position_ned,
                                        path.points[leg + 1].position_ned) <= path.legs[leg].corridor_m;
    const int parts = kept ? 1 : 2;
    for (int part = 1; part <= parts; ++part) {
      finer.places.push_back(part == parts ? knots.places[i + 1]
                                           : PositionYaw(0.5 * (knots.places[i] + knots.places[i + 1])));
      finer.leg.push_back(leg);
      finer.durations_s.push_back(knots.durations_s[i] / parts);
    }
  }
  const bool changed = finer.leg.size() > knots.leg.size();
  knots = std::move(finer);
  return changed;
}

// Plans a spline from the stop at point `first` to the one at point `last`.
void add_spline(const WaypointPath& path, std::size_t first, std::size_t last, PlannedPath& planned) {
  Knots knots;
  for (std::size_t i = first; i <= last; ++i) knots.places.push_back(place_of(path.points[i]));
  for (std::size_t i = first; i < last; ++i) {
    knots.leg.push_back(i);
    knots.durations_s.push_back(first_duration(knots.places[i - first], knots.places[i - first + 1],
                                               i == first || i + 1 == last, path.limits));
  }
  const bool in_corridors =
      !path.legs.empty() && std::any_of(path.legs.begin() + static_cast<std::ptrdiff_t>(first),
                                        path.legs.begin() + static_cast<std::ptrdiff_t>(last),
                                        [](const Leg& leg) { return leg.shape == LegShape::kCorridor; });
  if (!in_corridors) smooth(knots, path.smoothness);  // it would take time from the corners
  std::vector<PolynomialSegment> segments;
  for (int round = 0;; ++round) {
    balance(knots, path.smoothness, path.limits);
    segments = spline(path.smoothness, knots.places, knots.durations_s);
    if (planned.segments.size() + segments.size() > kMaxTrajectorySegments) {
      reject("the path takes more than " + std::to_string(kMaxTrajectorySegments) + " segments");
    }
    if (!refine(knots, segments, path)) break;
    if (round == kMaxRefinements) {
      reject("the corridor between points " + std::to_string(first + 1) + " and " + std::to_string(last + 1) +
             " is too narrow to fly through: stop at its corners");
    }
  }
  double factor = 0.0;
  for (const PolynomialSegment& segment : segments)
    factor = std::max(factor, limit_use(segment, path.limits).stretch());
  stretch(segments, factor);
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (i == 0 || knots.leg[i] != knots.leg[i - 1]) planned.leg_begins.push_back(planned.segments.size());
    planned.segments.push_back(segments[i]);
  }
}

double greatest_length(const PolynomialSegment& segment, int derivative, double limit) {
  const auto axis = [&](const Polynomial& p) { return bernstein(p, segment.duration_s, derivative); };
  const double tolerance = kExtremumPrecision * limit * limit;
  const Extremum square =
      maximum(squared_length(axis(segment.x), axis(segment.y), axis(segment.z)), tolerance);
  return std::sqrt(std::max(square.value + tolerance, 0.0)) / limit;
}

}  // namespace

double LimitUse::stretch() const {
  return std::max({speed, std::sqrt(acceleration), std::cbrt(jerk), yaw_rate});
}

LimitUse limit_use(const PolynomialSegment& segment, const MotionLimits& limits) {
  LimitUse use;
  use.speed = greatest_length(segment, 1, limits.speed);
  use.acceleration = greatest_length(segment, 2, limits.acceleration);
  use.jerk = greatest_length(segment, 3, limits.jerk);
  const Bernstein yaw_rate = bernstein(segment.yaw, segment.duration_s, 1);
  const double tolerance = kExtremumPrecision * limits.yaw_rate;
  const double fastest = std::max(maximum(yaw_rate, tolerance).value, -minimum(yaw_rate, tolerance).value);
  use.yaw_rate = (fastest + tolerance) / limits.yaw_rate;
  return use;
}

PlannedPath plan(const WaypointPath& path) {
  check(path);
  const std::size_t legs = path.points.size() - 1;
  const auto on_the_spot = [&](std::size_t leg) {
    return (path.points[leg + 1].position_ned - path.points[leg].position_ned).norm() < kSamePlace_m;
  };
  const auto straight = [&](std::size_t leg) {
    return on_the_spot(leg) || (!path.legs.empty() && path.legs[leg].shape == LegShape::kStraight);
  };
  PlannedPath planned;
  for (std::size_t first = 0; first < legs;) {
    std::size_t last = first + 1;
    if (straight(first)) {
      planned.leg_begins.push_back(planned.segments.size());
      const PathPoint& from = path.points[first];
      const PathPoint& to = path.points[last];
      for (const PolynomialSegment& segment :
           limited_jerk_leg(from.position_ned, from.yaw_rad, to.position_ned, to.yaw_rad, path.limits))
        planned.segments.push_back(segment);
    } else {
      while (last < legs && !path.points[last].stop && !straight(last)) ++last;
      add_spline(path, first, last, planned);
    }
    first = last;
  }
  if (planned.segments.empty()) reject("the path has no length: all points are at one place");
  if (planned.segments.size() > kMaxTrajectorySegments)
    reject("the path takes more than " + std::to_string(kMaxTrajectorySegments) + " segments");
  for (const PolynomialSegment& segment : planned.segments) planned.duration_s += segment.duration_s;
  return planned;
}

}  // namespace swiftlet::control

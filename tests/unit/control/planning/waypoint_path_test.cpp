#include "swiftlet/control/planning/waypoint_path.hpp"

#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

namespace swiftlet::control::waypoint_path_test {

using Eigen::Vector3d;

struct Peaks {
  double speed = 0.0, acceleration = 0.0, jerk = 0.0, yaw_rate = 0.0;
};
Peaks peaks(const std::vector<PolynomialSegment>& segments) {
  Peaks out;
  for (const PolynomialSegment& segment : segments) {
    for (int i = 0; i <= 200; ++i) {
      const Reference r = evaluate(segment, segment.duration_s * i / 200);
      out.speed = std::max(out.speed, r.velocity_ned.norm());
      out.acceleration = std::max(out.acceleration, r.acceleration_ned.norm());
      out.jerk = std::max(out.jerk, r.jerk_ned.norm());
      out.yaw_rate = std::max(out.yaw_rate, std::abs(r.yaw_rate));
    }
  }
  return out;
}

double greatest_use(const Peaks& peaks, const MotionLimits& limits) {
  return std::max({peaks.speed / limits.speed, peaks.acceleration / limits.acceleration,
                   peaks.jerk / limits.jerk, peaks.yaw_rate / limits.yaw_rate});
}

// Continuous in position, velocity, acceleration and yaw.
void expect_continuous(const std::vector<PolynomialSegment>& segments) {
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Reference before = evaluate(segments[i - 1], segments[i - 1].duration_s);
    const Reference after = evaluate(segments[i], 0.0);
    EXPECT_LT((before.position_ned - after.position_ned).norm(), 1e-8);
    EXPECT_LT((before.velocity_ned - after.velocity_ned).norm(), 1e-7);
    EXPECT_LT((before.acceleration_ned - after.acceleration_ned).norm(), 1e-6);
    EXPECT_NEAR(before.yaw_rad, after.yaw_rad, 1e-8);
  }
}

double duration(const std::vector<PolynomialSegment>& segments) {
  double sum = 0.0;
  for (const PolynomialSegment& segment : segments) sum += segment.duration_s;
  return sum;
}

WaypointPath random_path(unsigned seed, int points) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> place(-2.0, 2.0);
  WaypointPath path;
  for (int i = 0; i < points; ++i)
    path.points.push_back(
        {{place(generator), place(generator), -1.2 + 0.4 * place(generator)}, place(generator), false});
  return path;
}

WaypointPath square() {
  WaypointPath path;
  for (const Vector3d& corner :
       {Vector3d(0, 0, -1), Vector3d(2, 0, -1), Vector3d(2, 2, -1), Vector3d(0, 2, -1), Vector3d(0, 0, -1)})
    path.points.push_back({corner, 0.0, false});
  return path;
}

// Largest distance of a segment from the line between two points, with any overshoot beyond its ends.
double worst_distance(const PolynomialSegment& segment, const Vector3d& from, const Vector3d& to) {
  const Vector3d along = (to - from).normalized();
  double worst = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const Vector3d p = evaluate(segment, segment.duration_s * i / 400).position_ned - from;
    const double projection = std::clamp(along.dot(p), 0.0, (to - from).norm());
    worst = std::max(worst, (p - projection * along).norm());
  }
  return worst;
}

TEST(LimitedJerkLeg, StaysWithinItsLimitsAndReachesTheJerkLimit) {
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> exponent(-1.0, 1.0);
  int cruises = 0;
  int at_acceleration = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto size = [&] { return std::pow(10.0, exponent(generator)); };
    const MotionLimits limits{size(), size(), 10.0 * size(), 10.0 * size()};
    const Vector3d from(0.3, -0.4, -1.0);
    const Vector3d to = from + size() * Vector3d(2.0, -1.0, 2.0) / 3.0;
    const auto segments = limited_jerk_leg(from, 0.4, to, -0.2, limits);
    ASSERT_LE(segments.size(), 7U);
    const Peaks got = peaks(segments);
    EXPECT_LE(greatest_use(got, limits), 1.0 + 1e-9);
    EXPECT_NEAR(got.jerk, limits.jerk, 1e-9 * limits.jerk);
    expect_continuous(segments);
    const Reference end = evaluate(segments.back(), segments.back().duration_s);
    EXPECT_LT((end.position_ned - to).norm(), 1e-9);
    EXPECT_LT(end.velocity_ned.norm(), 1e-8);
    EXPECT_LT(end.acceleration_ned.norm(), 1e-8);
    EXPECT_NEAR(end.yaw_rad, -0.2, 1e-9);
    for (const PolynomialSegment& segment : segments) EXPECT_LT(worst_distance(segment, from, to), 1e-9);
    cruises += got.speed > limits.speed * (1.0 - 1e-9) ? 1 : 0;
    at_acceleration += got.acceleration > limits.acceleration * (1.0 - 1e-9) ? 1 : 0;
  }
  EXPECT_GT(cruises, 30);
  EXPECT_GT(at_acceleration, 30);
}

// The least time of a double integrator with limited jerk is known: 4 pieces of cbrt(d / 2j) for a short leg.
TEST(LimitedJerkLeg, TakesTheMinimumTime) {
  const MotionLimits limits{100.0, 100.0, 2.0, 1.0};
  EXPECT_NEAR(duration(limited_jerk_leg({0, 0, 0}, 0, {1, 0, 0}, 0, limits)), 4.0 * std::cbrt(1.0 / 4.0),
              1e-12);
  // d/v + v/a + a/j for a long one.
  const MotionLimits slow{0.5, 1.0, 4.0, 1.0};
  EXPECT_NEAR(duration(limited_jerk_leg({0, 0, 0}, 0, {3, 0, 0}, 0, slow)), 6.0 + 0.5 + 0.25, 1e-12);
}

TEST(LimitedJerkLeg, HandlesLegsOfZeroLength) {
  const MotionLimits limits;
  EXPECT_TRUE(limited_jerk_leg({1, 0, -1}, 0.3, {1, 0, -1}, 0.3, limits).empty());
  const auto turn = limited_jerk_leg({1, 0, -1}, 0.0, {1, 0, -1}, 2.0, limits);
  ASSERT_EQ(turn.size(), 1U);
  EXPECT_NEAR(peaks(turn).yaw_rate, limits.yaw_rate, 1e-3);
}

class Paths : public testing::TestWithParam<Smoothness> {};

TEST_P(Paths, PassThroughTheirPointsWithinTheLimits) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    WaypointPath path = random_path(seed, 2 + static_cast<int>(seed) * 3);
    path.smoothness = GetParam();
    path.limits = {0.5 + 0.2 * seed, 1.0 + 0.3 * (seed % 5), 4.0 + 5.0 * (seed % 4), 1.5};
    const PlannedPath planned = plan(path);
    ASSERT_EQ(planned.leg_begins.size(), path.points.size() - 1);
    for (std::size_t i = 0; i < planned.leg_begins.size(); ++i) {
      const Reference at = evaluate(planned.segments[planned.leg_begins[i]], 0.0);
      EXPECT_LT((at.position_ned - path.points[i].position_ned).norm(), 1e-12);
      EXPECT_NEAR(at.yaw_rad, path.points[i].yaw_rad, 1e-12);
    }
    const Reference end = evaluate(planned.segments.back(), planned.segments.back().duration_s);
    EXPECT_LT((end.position_ned - path.points.back().position_ned).norm(), 1e-8);
    EXPECT_LT(end.velocity_ned.norm(), 1e-6);
    expect_continuous(planned.segments);
    const double use = greatest_use(peaks(planned.segments), path.limits);
    EXPECT_LE(use, 1.0);
    EXPECT_GT(use, 0.98) << "slower than it needs to be";
    EXPECT_NEAR(planned.duration_s, duration(planned.segments), 1e-12);
  }
}

// Compares with a spline whose durations are proportional to the leg lengths and hold the limits.
TEST_P(Paths, AreFasterThanWithDurationsByLength) {
  double by_length_s = 0.0;
  double planned_s = 0.0;
  for (unsigned seed = 20; seed < 26; ++seed) {
    WaypointPath path = random_path(seed, 30);
    path.smoothness = GetParam();
    planned_s += plan(path).duration_s;
    std::vector<PositionYaw> places;
    std::vector<double> durations;
    for (const PathPoint& point : path.points) {
      const PositionYaw place(point.position_ned.x(), point.position_ned.y(), point.position_ned.z(),
                              point.yaw_rad);
      if (!places.empty()) durations.push_back((place - places.back()).head<3>().norm() / path.limits.speed);
      places.push_back(place);
    }
    double stretch = 0.0;
    for (const PolynomialSegment& segment : spline(GetParam(), places, durations))
      stretch = std::max(stretch, limit_use(segment, path.limits).stretch());
    for (const double d : durations) by_length_s += stretch * d;
  }
  EXPECT_LT(planned_s, 0.85 * by_length_s) << planned_s << " s against " << by_length_s << " s";
}

INSTANTIATE_TEST_SUITE_P(Costs, Paths, testing::Values(Smoothness::kMinimumJerk, Smoothness::kMinimumSnap),
                         [](const auto& smoothness) {
                           return smoothness.param == Smoothness::kMinimumSnap ? "MinimumSnap"
                                                                               : "MinimumJerk";
                         });

TEST(Path, StopsAtStopPoints) {
  WaypointPath path = random_path(7, 6);
  path.points[2].stop = true;
  const PlannedPath planned = plan(path);
  const Reference stop = evaluate(planned.segments[planned.leg_begins[2]], 0.0);
  EXPECT_LT(stop.velocity_ned.norm(), 1e-9);
  EXPECT_LT(stop.acceleration_ned.norm(), 1e-9);
  EXPECT_GT(evaluate(planned.segments[planned.leg_begins[3]], 0.0).velocity_ned.norm(), 0.1);
}

TEST(Path, StraightLegsAreStraight) {
  WaypointPath path = square();
  path.legs = {{LegShape::kStraight, 0.0}, {}, {LegShape::kStraight, 0.0}, {}};
  const PlannedPath planned = plan(path);
  expect_continuous(planned.segments);
  for (const std::size_t leg : {0U, 2U}) {
    for (std::size_t i = planned.leg_begins[leg]; i < planned.leg_begins[leg + 1]; ++i) {
      EXPECT_LT(worst_distance(planned.segments[i], path.points[leg].position_ned,
                               path.points[leg + 1].position_ned),
                1e-9);
    }
  }
  EXPECT_LE(greatest_use(peaks(planned.segments), path.limits), 1.0 + 1e-9);
}

TEST(Path, StaysInItsCorridorsWithoutStopping) {
  double before_s = 0.0;
  for (const double corridor_m : {0.3, 0.1, 0.05, 0.02, 0.005}) {
    SCOPED_TRACE(corridor_m);
    WaypointPath path = square();
    path.legs.assign(4, {LegShape::kCorridor, corridor_m});
    const PlannedPath planned = plan(path);
    expect_continuous(planned.segments);
    double worst = 0.0;
    for (std::size_t leg = 0; leg < 4; ++leg) {
      const std::size_t end = leg == 3 ? planned.segments.size() : planned.leg_begins[leg + 1];
      for (std::size_t i = planned.leg_begins[leg]; i < end; ++i)
        worst = std::max(worst, worst_distance(planned.segments[i], path.points[leg].position_ned,
                                               path.points[leg + 1].position_ned));
    }
    EXPECT_LE(worst, corridor_m);
    EXPECT_LE(greatest_use(peaks(planned.segments), path.limits), 1.0);
    for (std::size_t leg = 1; leg < 4; ++leg)
      EXPECT_GT(evaluate(planned.segments[planned.leg_begins[leg]], 0.0).velocity_ned.norm(), 1e-3);
    EXPECT_GT(planned.duration_s, before_s * 0.9) << "a narrower corridor should not be faster";
    before_s = planned.duration_s;
  }
}

TEST(Path, LeavesTheLegsWithoutACorridor) {
  const WaypointPath path = square();
  const PlannedPath planned = plan(path);
  double worst = 0.0;
  for (std::size_t leg = 0; leg < 4; ++leg)
    worst = std::max(worst, worst_distance(planned.segments[leg], path.points[leg].position_ned,
                                           path.points[leg + 1].position_ned));
  EXPECT_GT(worst, 0.3);
}

TEST(Path, StopsAndTurnsAtRepeatedPoints) {
  WaypointPath path = square();
  path.points[2].position_ned = path.points[1].position_ned;
  path.points[2].yaw_rad = 1.0;
  const PlannedPath planned = plan(path);
  expect_continuous(planned.segments);
  EXPECT_LT(evaluate(planned.segments[planned.leg_begins[1]], 0.0).velocity_ned.norm(), 1e-9);
  EXPECT_LE(greatest_use(peaks(planned.segments), path.limits), 1.0 + 1e-9);
}

std::string refusal(const WaypointPath& path) {
  try {
    plan(path);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "it was planned";
}

TEST(Path, RefusesInvalidInput) {
  WaypointPath path = square();
  path.points.resize(1);
  EXPECT_EQ(refusal(path), "the path has 1 points, must have at least 2");
  path = square();
  path.points[3].position_ned.y() = std::nan("");
  EXPECT_EQ(refusal(path), "point 4: a value is not a finite number");
  path = square();
  path.limits.jerk = 0.0;
  EXPECT_EQ(refusal(path), "the limit of jerk is 0, must be above 0");
  path = square();
  path.legs.resize(3);
  EXPECT_EQ(refusal(path), "the path has 3 legs between 5 points, must be one fewer than points");
  path = square();
  path.legs.assign(4, {LegShape::kCorridor, 0.0005});
  EXPECT_EQ(refusal(path), "leg 1: the corridor is 0.0005 m, must be at least 0.001 m");
  path.points.assign(3, {});
  path.legs.clear();
  EXPECT_EQ(refusal(path), "the path has no length: all points are at one place");
  EXPECT_EQ(plan(random_path(1, kMaxTrajectorySegments + 1)).segments.size(),
            std::size_t{kMaxTrajectorySegments});
  EXPECT_EQ(refusal(random_path(1, kMaxTrajectorySegments + 2)),
            "the path has 1026 points, at most 1025 fit");
}

}  // namespace swiftlet::control::waypoint_path_test

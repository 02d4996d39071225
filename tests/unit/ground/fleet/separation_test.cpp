#include "swiftlet/ground/fleet/separation.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::ground::separation_test {

using control::PolynomialSegment;

const Ellipsoid kSmall{0.15, 0.3};

PolynomialSegment line(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double duration_s) {
  return control::minimum_jerk(from, 0.0, to, 0.0, duration_s);
}

// From the ground at random pieces to somewhere, each a minimum-jerk move.
FlightPath random_path(std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(-1.0, 1.0), duration_s(0.3, 3.0);
  std::vector<FlightPath::Piece> pieces;
  Eigen::Vector3d at(place(random), place(random), 0.0);
  double now_s = 0.0;
  for (int i = 0; i < 5; ++i) {
    const Eigen::Vector3d to(place(random), place(random), place(random) - 1.0);
    pieces.push_back({now_s, line(at, to, duration_s(random))});
    now_s = pieces.back().end_s();
    at = to;
  }
  return FlightPath(std::move(pieces));
}

TEST(FlightPath, PartsContinueThePieces) {
  std::mt19937_64 random(3);
  const FlightPath path = random_path(random);
  for (const FlightPath::Piece& piece : path.pieces()) {
    const double start_s = piece.start_s + 0.3 * piece.segment.duration_s;
    const PolynomialSegment part = path.part(start_s, 0.5 * piece.segment.duration_s);
    for (const double share : {0.0, 0.4, 1.0}) {
      const double t = share * part.duration_s;
      EXPECT_LT((control::evaluate(part, t).position_ned - path.at(start_s + t)).norm(), 1e-9);
    }
  }
  const PolynomialSegment after = path.part(path.duration_s() + 1.0, 2.0);
  EXPECT_EQ(control::evaluate(after, 1.0).position_ned, path.at(1e6));
}

TEST(FlightPath, StandsBeforeBetweenAndAfterTheLegsOfADryRun) {
  MissionDryRun flight;
  flight.legs.push_back({line({1, 2, 0}, {1, 2, -1}, 2.0), 0.8, 0});
  flight.legs.push_back({line({1, 2, -1}, {1, 2, -0.08}, 3.0), 5.0, 1});
  flight.duration_s = 8.5;
  const FlightPath path = FlightPath::of(flight, {1, 2}, true);
  EXPECT_EQ(path.at(-1.0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(path.at(0.5), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(path.at(4.0), Eigen::Vector3d(1, 2, -1));
  EXPECT_NEAR(path.at(8.25).z(), -0.04, 1e-9);
  EXPECT_NEAR(path.at(8.5).z(), 0.0, 1e-9);
  EXPECT_NEAR(path.at(60.0).z(), 0.0, 1e-9);
  EXPECT_DOUBLE_EQ(path.duration_s(), 8.5);
  EXPECT_NEAR(FlightPath::of(flight, {1, 2}, false).at(60.0).z(), -0.08, 1e-9);
}

TEST(Separation, TouchesAtTheSumOfTheRadii) {
  EXPECT_DOUBLE_EQ(clearance(kSmall, kSmall, {0.3, 0, 0}), 1.0);
  EXPECT_DOUBLE_EQ(clearance(kSmall, kSmall, {0, 0, -0.6}), 1.0);
  EXPECT_DOUBLE_EQ(clearance({0.1, 0.2}, {0.3, 0.6}, {0, -0.4, 0}), 1.0);
  EXPECT_LT(clearance(kSmall, kSmall, {0.2, 0, 0.4}), 1.0);
}

// The bound holds at every sample of 1 ms, and the point that is named attains it.
TEST(Separation, BoundsTheDistanceOfRandomPathsEverywhere) {
  std::mt19937_64 random(21);
  for (int run = 0; run < 60; ++run) {
    const FlightPath a = random_path(random);
    const FlightPath b = random_path(random);
    const Approach closest = closest_approach(a, kSmall, b, kSmall);
    double sampled = 1e9;
    for (double t = 0.0; t < std::max(a.duration_s(), b.duration_s()) + 1.0; t += 0.001)
      sampled = std::min(sampled, clearance(kSmall, kSmall, b.at(t) - a.at(t)));
    EXPECT_LE(closest.clearance, sampled + 1e-9);
    EXPECT_NEAR(clearance(kSmall, kSmall, closest.b_ned - closest.a_ned), closest.clearance, 0.004);
    EXPECT_EQ(closest.a_ned, a.at(closest.time_s));
    EXPECT_LT(sampled - closest.clearance, 0.02);
  }
}

// Two vehicles that pass each other in a millisecond, at a moment between all samples.
TEST(Separation, FindsAnApproachThatIsShorterThanAnySample) {
  const auto fast = [](double y, double direction) {
    PolynomialSegment segment;
    segment.duration_s = 1.0;
    segment.x = {-500.0 * direction, 1000.0 * direction};
    segment.y = {y};
    segment.z = {-1.0};
    return FlightPath({{0.0, segment}});
  };
  const Approach closest = closest_approach(fast(0.0, 1.0), kSmall, fast(0.2, -1.0), kSmall);
  EXPECT_NEAR(closest.clearance, 0.2 / 0.3, 1e-4);
  EXPECT_NEAR(closest.time_s, 0.5, 1e-4);
}

TEST(Separation, HoldsForStandingVehicles) {
  const auto standing = [](double x, double duration_s) {
    return FlightPath({{0.0, line({x, 0, 0}, {x, 0, 0}, duration_s)}});
  };
  EXPECT_NEAR(closest_approach(standing(0, 1), kSmall, standing(0.3, 5), kSmall).clearance, 1.0, 1e-5);
  EXPECT_NEAR(closest_approach(standing(0, 1), kSmall, standing(0, 5), kSmall).clearance, 0.0, 1e-9);
}

}  // namespace swiftlet::ground::separation_test

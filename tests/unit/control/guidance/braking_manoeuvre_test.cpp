// Braking to rest: within the limits from any motion within them, and no slower than necessary.
#include "swiftlet/control/guidance/braking_manoeuvre.hpp"

#include <algorithm>
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/math/random.hpp"
#include "tests/support/malloc_guard.hpp"

namespace swiftlet::control::braking_manoeuvre_test {

using Eigen::Vector3d;

constexpr double kPeakAcceleration = 2.0;  // m/s^2
constexpr double kPeakJerk = 8.0;          // m/s^3
constexpr double kRounding = 1.0 + 1e-9;

Reference motion(const Vector3d& velocity_ned, const Vector3d& acceleration_ned) {
  Reference reference;
  reference.position_ned = {0.3, -0.2, -1.0};
  reference.velocity_ned = velocity_ned;
  reference.acceleration_ned = acceleration_ned;
  reference.yaw_rad = 0.4;
  return reference;
}

PolynomialSegment stop(const Reference& from) {
  const BrakingManoeuvre stop = limited_braking(from, kPeakAcceleration, kPeakJerk, 0.01);
  return join_to_rest(from, stop.place_ned, from.yaw_rad, stop.duration_s);
}

struct Peaks {
  double acceleration = 0.0;
  double jerk = 0.0;
};
Peaks peaks(const PolynomialSegment& segment) {
  constexpr int kSamples = 400;
  Peaks most;
  for (int i = 0; i <= kSamples; ++i) {
    const Reference at = evaluate(segment, segment.duration_s * i / kSamples);
    most.acceleration = std::max(most.acceleration, at.acceleration_ned.norm());
    most.jerk = std::max(most.jerk, at.jerk_ned.norm());
  }
  return most;
}

TEST(BrakingManoeuvre, StaysWithinTheLimitsFromAnyMotionWithinThem) {
  math::RandomStream random(1, 1);
  double most_acceleration = 0.0, most_jerk = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const Reference from = motion(random.log_uniform(1e-3, 3.0) * random.on_unit_sphere(),
                                  kPeakAcceleration * random.uniform() * random.on_unit_sphere());
    const Peaks most = peaks(stop(from));
    ASSERT_LE(most.acceleration, kPeakAcceleration * kRounding) << i;
    ASSERT_LE(most.jerk, kPeakJerk * kRounding) << i;
    most_acceleration = std::max(most_acceleration, most.acceleration);
    most_jerk = std::max(most_jerk, most.jerk);
  }
  EXPECT_GT(most_acceleration, 0.99 * kPeakAcceleration);
  EXPECT_GT(most_jerk, 0.99 * kPeakJerk);
}

TEST(BrakingManoeuvre, StartsFromTheMotionAndEndsAtRest) {
  math::RandomStream random(2, 1);
  for (int i = 0; i < 200; ++i) {
    const Reference from =
        motion(2.0 * random.on_unit_sphere(), random.uniform(0.0, 4.0) * random.on_unit_sphere());
    const PolynomialSegment segment = stop(from);
    const Reference begin = evaluate(segment, 0.0);
    EXPECT_LT((begin.position_ned - from.position_ned).norm(), 1e-12);
    EXPECT_LT((begin.velocity_ned - from.velocity_ned).norm(), 1e-12);
    EXPECT_LT((begin.acceleration_ned - from.acceleration_ned).norm(), 1e-12);
    const Reference end = evaluate(segment, segment.duration_s);
    EXPECT_LT(end.velocity_ned.norm(), 1e-9);
    EXPECT_LT(end.acceleration_ned.norm(), 1e-9);
    for (const Polynomial* axis : {&segment.x, &segment.y, &segment.z}) EXPECT_NEAR((*axis)[5], 0.0, 1e-9);
  }
}

// On a straight line one of the limits is reached: a quartic cannot be faster.
TEST(BrakingManoeuvre, ReachesALimitOnAStraightLine) {
  for (const double speed : {0.05, 0.4, 1.0, 2.0, 4.0}) {
    for (const double acceleration : {0.0, 0.5, 1.0, 2.0}) {
      const Peaks most = peaks(stop(motion({speed, 0, 0}, {acceleration, 0, 0})));
      EXPECT_GT(std::max(most.acceleration / kPeakAcceleration, most.jerk / kPeakJerk), 0.999)
          << speed << " m/s, " << acceleration << " m/s^2";
    }
  }
}

TEST(BrakingManoeuvre, DoesNotIncreaseAMotionBeyondTheLimits) {
  const Reference from = motion({1.0, 0, 0}, {2.5 * kPeakAcceleration, 0, 0});
  const Peaks most = peaks(stop(from));
  EXPECT_LE(most.acceleration, 2.5 * kPeakAcceleration * kRounding);
  EXPECT_LE(most.jerk, 2.5 * kPeakJerk * kRounding);
}

// From rest with acceleration a the largest jerk is 4 a / T, at the start. A motion with twice the limit of
// acceleration A may use twice the limit of jerk J: T = 4 A / J.
TEST(BrakingManoeuvre, LetsAMotionBeyondTheLimitsBrakeAsMuchHarder) {
  const Reference from = motion(Vector3d::Zero(), {2.0 * kPeakAcceleration, 0, 0});
  EXPECT_NEAR(limited_braking(from, kPeakAcceleration, kPeakJerk, 0.0).duration_s,
              4.0 * kPeakAcceleration / kPeakJerk, 1e-12);
}

TEST(BrakingManoeuvre, StaysInPlaceForTheMinimumDuration) {
  const Reference from = motion(Vector3d::Zero(), Vector3d::Zero());
  const BrakingManoeuvre stop = limited_braking(from, kPeakAcceleration, kPeakJerk, 0.5);
  EXPECT_EQ(stop.duration_s, 0.5);
  EXPECT_EQ(stop.place_ned, from.position_ned);
}

TEST(BrakingManoeuvre, AllocatesNoMemory) {
  const Reference from = motion({1, 0, 0}, {0, 1, 0});
  const test::MallocGuard guard;
  const PolynomialSegment segment = stop(from);
  EXPECT_EQ(guard.calls(), 0U);
  EXPECT_GT(segment.duration_s, 0.0);
}

}  // namespace swiftlet::control::braking_manoeuvre_test

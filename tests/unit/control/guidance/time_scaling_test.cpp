#include "swiftlet/control/guidance/time_scaling.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/control/guidance/reference_path.hpp"

namespace swiftlet::control::time_scaling_test {

constexpr std::int64_t kSecond = 1'000'000'000;

PolynomialSegment curve() {
  PolynomialSegment segment;
  segment.duration_s = 6.0;
  segment.x = {0.0, 0.9, 0.2, -0.05, 0.003};
  segment.y = {1.0, -0.4, 0.3, 0.02, -0.006};
  segment.z = {-1.0, 0.1, -0.1, 0.01};
  segment.yaw = {0.2, 0.5, -0.1};
  return segment;
}

TEST(TimeScaling, IsVehicleTimeUntilTheFirstChange) {
  const TimeScaling clock;
  for (const std::int64_t now_ns : {std::int64_t{0}, std::int64_t{1}, 12'345 * kSecond + 7}) {
    EXPECT_EQ(clock.at(now_ns).at_ns, now_ns);
    EXPECT_EQ(clock.at(now_ns).rate, 1.0);
  }
  EXPECT_TRUE(clock.is_vehicle_time());
}

TEST(TimeScaling, StopsHalfTheChangeLaterAndResumesThere) {
  TimeScaling clock;
  clock.turn(false, 2.0, 10 * kSecond);
  EXPECT_TRUE(clock.is_changing(12 * kSecond - 1));
  EXPECT_FALSE(clock.is_changing(12 * kSecond));
  EXPECT_NEAR(static_cast<double>(clock.at(12 * kSecond).at_ns), 11e9, 2.0) << "by symmetry";
  EXPECT_EQ(clock.at(99 * kSecond).at_ns, clock.at(12 * kSecond).at_ns);
  EXPECT_EQ(clock.at(99 * kSecond).rate, 0.0);
  clock.turn(true, 1.0, 100 * kSecond);
  EXPECT_NEAR(static_cast<double>(clock.at(101 * kSecond).at_ns), 11.5e9, 3.0);
  EXPECT_NEAR(static_cast<double>(clock.at(103 * kSecond).at_ns), 13.5e9, 3.0);
  EXPECT_EQ(clock.at(103 * kSecond).rate, 1.0);
}

TEST(TimeScaling, ReversedDuringAChangeIsContinuousAndNeverBackwards) {
  for (const bool first : {false, true}) {
    for (double after_s = 0.01; after_s < 1.0; after_s += 0.03) {
      TimeScaling clock = first ? TimeScaling::standing_at(0, 0) : TimeScaling();
      clock.turn(first, 1.0, 0);
      const auto turn_ns = static_cast<std::int64_t>(after_s * 1e9);
      const PathTime before = clock.at(turn_ns);
      clock.turn(!first, 1.0, turn_ns);
      const PathTime after = clock.at(turn_ns);
      EXPECT_EQ(after.at_ns, before.at_ns);
      EXPECT_NEAR(after.rate, before.rate, 1e-12);
      EXPECT_NEAR(after.acceleration, before.acceleration, 1e-12);
      EXPECT_NEAR(after.jerk, before.jerk, 1e-11);
      double least = 1.0;
      double greatest = 0.0;
      for (std::int64_t t = 0; t <= kSecond; t += kSecond / 200) {
        least = std::min(least, clock.at(turn_ns + t).rate);
        greatest = std::max(greatest, clock.at(turn_ns + t).rate);
      }
      EXPECT_GT(least, -0.001) << "turned after " << after_s << " s";
      EXPECT_LT(greatest, 1.001);
    }
  }
}

// The chain rule against finite differences.
TEST(TimeScaling, ReferenceDerivativesMatchFiniteDifferences) {
  ReferencePath path;
  path.follow(curve(), 0);
  path.clock.turn(false, 1.5, kSecond);
  constexpr std::int64_t kStep = 100'000;
  const double dt = 1e-9 * kStep;
  for (std::int64_t now = kSecond + 5 * kStep; now < 2'499'000'000; now += 37'000'000) {
    const Reference a = path.at(now - kStep);
    const Reference b = path.at(now);
    const Reference c = path.at(now + kStep);
    EXPECT_LT(((c.position_ned - a.position_ned) / (2 * dt) - b.velocity_ned).norm(), 1e-4);
    EXPECT_LT(((c.velocity_ned - a.velocity_ned) / (2 * dt) - b.acceleration_ned).norm(), 1e-3);
    EXPECT_LT(((c.acceleration_ned - a.acceleration_ned) / (2 * dt) - b.jerk_ned).norm(), 1e-2);
    EXPECT_LT(((c.jerk_ned - a.jerk_ned) / (2 * dt) - b.snap_ned).norm(), 0.1);
    EXPECT_NEAR((c.yaw_rad - a.yaw_rad) / (2 * dt), b.yaw_rate, 1e-4);
    EXPECT_NEAR((c.yaw_rate - a.yaw_rate) / (2 * dt), b.yaw_acceleration, 1e-3);
  }
}

TEST(TimeScaling, ScaledMotionStaysWithinTheLimits) {
  const double speed = 1.7;
  const double duration_s = clock_change_duration(speed, 2.0, 20.0, 0.5);
  ReferencePath path;
  PolynomialSegment line;
  line.duration_s = 10.0;
  line.x = {0.0, speed};
  path.follow(line, 0);
  path.clock.turn(false, duration_s, kSecond);
  double acceleration = 0.0;
  double jerk = 0.0;
  for (std::int64_t now = kSecond; now < 5 * kSecond; now += 1'000'000) {
    acceleration = std::max(acceleration, path.at(now).acceleration_ned.norm());
    jerk = std::max(jerk, path.at(now).jerk_ned.norm());
  }
  EXPECT_NEAR(acceleration, 2.0, 1e-3) << "the limit of acceleration is reached";
  EXPECT_LT(jerk, 20.0);
}

TEST(TimeScaling, TakingVehicleTimeKeepsTheReference) {
  ReferencePath path;
  path.follow(curve(), 0);
  path.clock.turn(false, 1.0, kSecond);
  path.clock.turn(true, 1.0, 3 * kSecond);
  const std::int64_t now = 4 * kSecond + 2'000'000;
  ReferencePath taken = path;
  const std::int64_t behind_ns = taken.take_vehicle_time(now);
  EXPECT_NEAR(static_cast<double>(behind_ns), 2e9, 5.0);
  EXPECT_TRUE(taken.clock.is_vehicle_time());
  for (const std::int64_t later : {now, now + kSecond / 3, now + 10 * kSecond}) {
    EXPECT_EQ(taken.at(later).position_ned, path.at(later).position_ned);
    EXPECT_EQ(taken.at(later).velocity_ned, path.at(later).velocity_ned);
    EXPECT_EQ(taken.finished(later), path.finished(later));
  }
}

}  // namespace swiftlet::control::time_scaling_test

#include "swiftlet/control/types/polynomial.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace swiftlet::control::polynomial_test {

using Eigen::Vector3d;

PolynomialSegment random_segment(unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> coefficient(-1.0, 1.0);
  PolynomialSegment segment;
  segment.duration_s = 2.0;
  for (Polynomial* axis : {&segment.x, &segment.y, &segment.z, &segment.yaw}) {
    for (double& c : *axis) c = coefficient(generator);
  }
  return segment;
}

// d^k/dt^k of the sum of c[i] t^i, term by term.
double derivative(const Polynomial& c, int k, double t) {
  double sum = 0.0;
  for (int i = k; i < kPolynomialCoefficients; ++i) {
    double factor = 1.0;
    for (int j = 0; j < k; ++j) factor *= i - j;
    sum += c[static_cast<std::size_t>(i)] * factor * std::pow(t, i - k);
  }
  return sum;
}

TEST(Polynomial, DerivativesAreExact) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const PolynomialSegment s = random_segment(seed);
    for (const double t : {0.0, 0.3, 1.0, 1.7, 2.0}) {
      const Reference r = evaluate(s, t);
      const std::array<const Polynomial*, 3> axes = {&s.x, &s.y, &s.z};
      for (int i = 0; i < 3; ++i) {
        const Polynomial& c = *axes[static_cast<std::size_t>(i)];
        EXPECT_NEAR(r.position_ned[i], derivative(c, 0, t), 1e-10);
        EXPECT_NEAR(r.velocity_ned[i], derivative(c, 1, t), 1e-10);
        EXPECT_NEAR(r.acceleration_ned[i], derivative(c, 2, t), 1e-9);
        EXPECT_NEAR(r.jerk_ned[i], derivative(c, 3, t), 1e-9);
        EXPECT_NEAR(r.snap_ned[i], derivative(c, 4, t), 1e-8);
      }
      EXPECT_NEAR(r.yaw_rad, derivative(s.yaw, 0, t), 1e-10);
      EXPECT_NEAR(r.yaw_rate, derivative(s.yaw, 1, t), 1e-10);
      EXPECT_NEAR(r.yaw_acceleration, derivative(s.yaw, 2, t), 1e-9);
    }
  }
}

TEST(Polynomial, TimeIsClampedToTheSegment) {
  const PolynomialSegment s = random_segment(7);
  EXPECT_EQ(evaluate(s, -1.0).position_ned, evaluate(s, 0.0).position_ned);
  EXPECT_EQ(evaluate(s, 9.0).position_ned, evaluate(s, s.duration_s).position_ned);
}

void expect_rest(const Reference& r, const Vector3d& at, double yaw) {
  EXPECT_LT((r.position_ned - at).norm(), 1e-12);
  EXPECT_LT(r.velocity_ned.norm(), 1e-12);
  EXPECT_LT(r.acceleration_ned.norm(), 1e-12);
  EXPECT_NEAR(r.yaw_rad, yaw, 1e-12);
  EXPECT_NEAR(r.yaw_rate, 0.0, 1e-12);
  EXPECT_NEAR(r.yaw_acceleration, 0.0, 1e-12);
}

TEST(MinimumJerk, MovesFromRestToRestOnAStraightLine) {
  const Vector3d from(1.0, -2.0, -0.5);
  const Vector3d to(-0.5, 0.7, -1.5);
  const PolynomialSegment s = minimum_jerk(from, 0.2, to, -0.9, 3.0);
  expect_rest(evaluate(s, 0.0), from, 0.2);
  expect_rest(evaluate(s, 3.0), to, -0.9);
  const Vector3d direction = (to - from).normalized();
  double before = -1.0;
  for (int i = 0; i <= 60; ++i) {
    const Vector3d offset = evaluate(s, 0.05 * i).position_ned - from;
    EXPECT_LT((offset - offset.dot(direction) * direction).norm(), 1e-12);
    EXPECT_GT(offset.dot(direction), before);
    before = offset.dot(direction);
  }
}

TEST(MinimumJerk, HasLessJerkThanOtherPolynomials) {
  // Adding any c t^3 (T - t)^3, which keeps all boundary conditions, costs jerk.
  const double duration = 2.0;
  const PolynomialSegment best = minimum_jerk(Vector3d::Zero(), 0.0, Vector3d(1.0, 0.0, 0.0), 0.0, duration);
  const auto cost = [&](double bump) {
    PolynomialSegment s = best;
    const double d = duration;
    s.x[3] += bump * d * d * d;
    s.x[4] -= bump * 3.0 * d * d;
    s.x[5] += bump * 3.0 * d;
    s.x[6] -= bump;
    double sum = 0.0;
    constexpr int kSteps = 2000;
    for (int i = 0; i < kSteps; ++i) {
      sum += evaluate(s, (i + 0.5) * duration / kSteps).jerk_ned.squaredNorm() * duration / kSteps;
    }
    return sum;
  };
  EXPECT_GT(cost(0.01), cost(0.0));
  EXPECT_GT(cost(-0.01), cost(0.0));
}

TEST(MinimumJerk, DurationReachesAPeakLimit) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> size(0.1, 4.0);
  bool by_speed = false;
  bool by_acceleration = false;
  bool by_jerk = false;
  for (int trial = 0; trial < 50; ++trial) {
    const double distance = size(generator);
    const double peak_speed = size(generator);
    const double peak_acceleration = size(generator);
    const double peak_jerk = 10.0 * size(generator);
    const double duration = minimum_jerk_duration(distance, peak_speed, peak_acceleration, peak_jerk);
    const PolynomialSegment s =
        minimum_jerk(Vector3d::Zero(), 0.0, distance * Vector3d(2.0, -1.0, 2.0) / 3.0, 0.0, duration);
    double speed = 0.0;
    double acceleration = 0.0;
    const double jerk = evaluate(s, 0.0).jerk_ned.norm();  // greatest at the ends
    for (int i = 0; i <= 4000; ++i) {
      const Reference r = evaluate(s, duration * i / 4000);
      speed = std::max(speed, r.velocity_ned.norm());
      acceleration = std::max(acceleration, r.acceleration_ned.norm());
    }
    EXPECT_LE(speed, peak_speed * (1.0 + 1e-12));
    EXPECT_LE(acceleration, peak_acceleration * (1.0 + 1e-12));
    const bool at_speed = speed > peak_speed * (1.0 - 1e-6);
    const bool at_acceleration = acceleration > peak_acceleration * (1.0 - 1e-6);
    EXPECT_LE(jerk, peak_jerk * (1.0 + 1e-12));
    const bool at_jerk = jerk > peak_jerk * (1.0 - 1e-6);
    EXPECT_TRUE(at_speed || at_acceleration || at_jerk) << "longer than it needs to be";
    by_jerk |= at_jerk;
    by_speed |= at_speed;
    by_acceleration |= at_acceleration;
  }
  EXPECT_TRUE(by_speed && by_acceleration && by_jerk);
  EXPECT_EQ(minimum_jerk_duration(0.0, 1.0, 1.0, 1.0), 0.1);
  EXPECT_EQ(minimum_jerk_duration(0.0, 1.0, 1.0, 1.0, 0.5), 0.5);
}

TEST(JoinToRest, StartsFromTheMotionAndEndsAtRest) {
  Reference from;
  from.position_ned = {0.3, -0.2, -1.0};
  from.velocity_ned = {0.5, 0.1, -0.4};
  from.acceleration_ned = {-1.0, 0.3, 0.8};
  from.yaw_rad = 0.4;
  from.yaw_rate = -0.3;
  from.yaw_acceleration = 0.6;
  const Vector3d to(1.0, 2.0, -1.5);
  const PolynomialSegment s = join_to_rest(from, to, -0.1, 2.5);
  const Reference start = evaluate(s, 0.0);
  EXPECT_LT((start.position_ned - from.position_ned).norm(), 1e-15);
  EXPECT_LT((start.velocity_ned - from.velocity_ned).norm(), 1e-15);
  EXPECT_LT((start.acceleration_ned - from.acceleration_ned).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(start.yaw_rad, from.yaw_rad);
  EXPECT_DOUBLE_EQ(start.yaw_rate, from.yaw_rate);
  EXPECT_DOUBLE_EQ(start.yaw_acceleration, from.yaw_acceleration);
  expect_rest(evaluate(s, 2.5), to, -0.1);
}

TEST(JoinToRest, FromRestIsMinimumJerk) {
  Reference from;
  from.position_ned = {0.3, -0.2, -1.0};
  const Vector3d to(1.0, 2.0, -1.5);
  const PolynomialSegment a = join_to_rest(from, to, 0.7, 2.0);
  const PolynomialSegment b = minimum_jerk(from.position_ned, 0.0, to, 0.7, 2.0);
  for (std::size_t i = 0; i < a.x.size(); ++i) {
    EXPECT_DOUBLE_EQ(a.x[i], b.x[i]);
    EXPECT_DOUBLE_EQ(a.z[i], b.z[i]);
    EXPECT_DOUBLE_EQ(a.yaw[i], b.yaw[i]);
  }
}

TEST(Join, MatchesBothReferences) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  const auto any = [&] {
    Reference r;
    for (Vector3d* const v : {&r.position_ned, &r.velocity_ned, &r.acceleration_ned, &r.jerk_ned})
      *v = {draw(generator), draw(generator), draw(generator)};
    r.yaw_rad = draw(generator);
    r.yaw_rate = draw(generator);
    r.yaw_acceleration = draw(generator);
    return r;
  };
  for (const double duration : {0.3, 1.0, 4.0}) {
    const Reference from = any();
    const Reference to = any();
    const PolynomialSegment s = join(from, to, duration);
    for (const auto& [got, wanted] :
         {std::pair(evaluate(s, 0.0), from), std::pair(evaluate(s, duration), to)}) {
      EXPECT_LT((got.position_ned - wanted.position_ned).norm(), 1e-12);
      EXPECT_LT((got.velocity_ned - wanted.velocity_ned).norm(), 1e-11);
      EXPECT_LT((got.acceleration_ned - wanted.acceleration_ned).norm(), 1e-10);
      EXPECT_LT((got.jerk_ned - wanted.jerk_ned).norm(), 1e-9);
      EXPECT_NEAR(got.yaw_rad, wanted.yaw_rad, 1e-12);
      EXPECT_NEAR(got.yaw_rate, wanted.yaw_rate, 1e-11);
      EXPECT_NEAR(got.yaw_acceleration, wanted.yaw_acceleration, 1e-10);
    }
  }
}

TEST(Stretched, IsTheSamePathMoreSlowly) {
  const PolynomialSegment quick = minimum_jerk({0, 1, -1}, 0.2, {1, 0, -2}, 0.9, 2.0);
  const PolynomialSegment slow = stretched(quick, 1.5);
  EXPECT_DOUBLE_EQ(slow.duration_s, 3.0);
  for (const double t : {0.0, 0.7, 2.0}) {
    const Reference a = evaluate(quick, t);
    const Reference b = evaluate(slow, 1.5 * t);
    EXPECT_LT((b.position_ned - a.position_ned).norm(), 1e-12);
    EXPECT_LT((1.5 * b.velocity_ned - a.velocity_ned).norm(), 1e-12);
    EXPECT_NEAR(b.yaw_rad, a.yaw_rad, 1e-12);
  }
}

TEST(Join, RestToRestDurationReachesAPeakLimit) {
  for (const auto& [speed, acceleration, jerk] :
       {std::array{0.5, 9.0, 99.0}, std::array{9.0, 0.5, 99.0}, std::array{9.0, 9.0, 0.5}}) {
    Reference to;
    to.position_ned = {0.6, 0.0, 0.8};
    const double duration = septic_duration(1.0, speed, acceleration, jerk);
    const PolynomialSegment s = join(Reference(), to, duration);
    double use = 0.0;
    for (int i = 0; i <= 4000; ++i) {
      const Reference r = evaluate(s, duration * i / 4000);
      use = std::max({use, r.velocity_ned.norm() / speed, r.acceleration_ned.norm() / acceleration,
                      r.jerk_ned.norm() / jerk});
    }
    EXPECT_NEAR(use, 1.0, 1e-5);
  }
}

}  // namespace swiftlet::control::polynomial_test

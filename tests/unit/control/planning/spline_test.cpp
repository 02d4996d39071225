#include "swiftlet/control/planning/spline.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace swiftlet::control::spline_test {

using Eigen::Vector3d;

// Value and derivatives 1 .. 6 of an axis at t.
std::array<double, 7> derivatives(const Polynomial& c, double t) {
  std::array<double, 7> d{};
  for (std::size_t k = 0; k < d.size(); ++k) {
    for (std::size_t i = k; i < c.size(); ++i) {
      double factor = 1.0;
      for (std::size_t j = 0; j < k; ++j) factor *= static_cast<double>(i - j);
      d[k] += factor * c[i] * std::pow(t, static_cast<double>(i - k));
    }
  }
  return d;
}
std::array<const Polynomial*, 4> axes(const PolynomialSegment& s) { return {&s.x, &s.y, &s.z, &s.yaw}; }

struct Case {
  std::vector<PositionYaw> points;
  std::vector<double> durations_s;
};
Case random_case(unsigned seed, int points) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> place(-3.0, 3.0);
  std::uniform_real_distribution<double> duration(0.2, 3.0);
  Case out;
  for (int i = 0; i < points; ++i) {
    out.points.emplace_back(place(generator), place(generator), place(generator), place(generator));
    if (i > 0) out.durations_s.push_back(duration(generator));
  }
  return out;
}

// The integral of the squared jerk or snap, by Simpson's rule on enough intervals to be exact to rounding.
double cost(const std::vector<PolynomialSegment>& segments, std::size_t order) {
  constexpr int kIntervals = 64;
  double sum = 0.0;
  for (const PolynomialSegment& segment : segments) {
    for (const Polynomial* const axis : axes(segment)) {
      for (int i = 0; i <= kIntervals; ++i) {
        const double weight = i == 0 || i == kIntervals ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
        const double d = derivatives(*axis, segment.duration_s * i / kIntervals)[order];
        sum += weight * d * d * segment.duration_s / (3.0 * kIntervals);
      }
    }
  }
  return sum;
}

class Splines : public testing::TestWithParam<Smoothness> {
 protected:
  std::size_t order() const { return GetParam() == Smoothness::kMinimumSnap ? 4 : 3; }
};

TEST_P(Splines, PassThroughThePointsFromRestToRest) {
  const Case c = random_case(1, 9);
  const auto segments = spline(GetParam(), c.points, c.durations_s);
  ASSERT_EQ(segments.size(), c.durations_s.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    EXPECT_EQ(segments[i].duration_s, c.durations_s[i]);
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      EXPECT_EQ(derivatives(*axes(segments[i])[axis], 0.0)[0], c.points[i][k]);
      EXPECT_NEAR(derivatives(*axes(segments[i])[axis], c.durations_s[i])[0], c.points[i + 1][k], 1e-10);
    }
  }
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const auto start = derivatives(*axes(segments.front())[axis], 0.0);
    const auto end = derivatives(*axes(segments.back())[axis], c.durations_s.back());
    for (std::size_t k = 1; k < order(); ++k) {
      EXPECT_NEAR(start[k], 0.0, 1e-10);
      EXPECT_NEAR(end[k], 0.0, 1e-7);
    }
  }
}

// Condition of the minimum cost: derivatives up to 2 (order - 1) are continuous.
TEST_P(Splines, HaveContinuousDerivativesAtThePoints) {
  const Case c = random_case(2, 12);
  const auto segments = spline(GetParam(), c.points, c.durations_s);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    for (std::size_t axis = 0; axis < 4; ++axis) {
      const auto before = derivatives(*axes(segments[i - 1])[axis], c.durations_s[i - 1]);
      const auto after = derivatives(*axes(segments[i])[axis], 0.0);
      double size = 1.0;
      for (std::size_t k = 0; k <= 2 * (order() - 1); ++k) {
        size = std::max({size, std::abs(before[k]), std::abs(after[k])});
        EXPECT_NEAR(before[k], after[k], 1e-8 * size) << "derivative " << k << " at point " << i;
      }
    }
  }
}

TEST_P(Splines, CostLessThanTheirNeighbours) {
  const Case c = random_case(3, 6);
  const double least = cost(spline(GetParam(), c.points, c.durations_s), order());
  // Neighbours: through the same points, with other derivatives at one of them.
  for (const double change : {-0.05, 0.05}) {
    for (std::size_t point = 1; point + 1 < c.points.size(); ++point) {
      const auto whole = spline(GetParam(), c.points, c.durations_s);
      PlaceDerivatives there;
      for (std::size_t axis = 0; axis < 4; ++axis) {
        const auto d = derivatives(*axes(whole[point])[axis], 0.0);
        for (int k = 0; k < 3; ++k)
          there(static_cast<Eigen::Index>(axis), k) = d[static_cast<std::size_t>(k) + 1];
      }
      there(1, 0) += change;
      const auto at = static_cast<std::ptrdiff_t>(point);
      auto changed =
          spline(GetParam(), {c.points.begin(), c.points.begin() + at + 1},
                 {c.durations_s.begin(), c.durations_s.begin() + at}, PlaceDerivatives::Zero(), there);
      const auto rest = spline(GetParam(), {c.points.begin() + at, c.points.end()},
                               {c.durations_s.begin() + at, c.durations_s.end()}, there);
      changed.insert(changed.end(), rest.begin(), rest.end());
      EXPECT_GT(cost(changed, order()), least * (1.0 + 1e-9));
    }
  }
}

TEST_P(Splines, StartAndEndWithGivenDerivatives) {
  const Case c = random_case(4, 4);
  PlaceDerivatives start;
  PlaceDerivatives end;
  start << 0.1, 0.2, 0.3, -0.4, 0.5, 0.6, 0.7, -0.8, 0.9, 0.1, 0.0, 0.2;
  end << -0.5, 0.4, 0.1, 0.3, 0.2, -0.6, 0.2, 0.8, -0.9, 0.3, 0.1, 0.0;
  const auto segments = spline(GetParam(), c.points, c.durations_s, start, end);
  for (std::size_t axis = 0; axis < 4; ++axis) {
    const auto from = derivatives(*axes(segments.front())[axis], 0.0);
    const auto to = derivatives(*axes(segments.back())[axis], c.durations_s.back());
    for (std::size_t k = 1; k < order(); ++k) {
      const auto row = static_cast<Eigen::Index>(axis);
      const auto column = static_cast<Eigen::Index>(k) - 1;
      EXPECT_NEAR(from[k], start(row, column), 1e-12);
      EXPECT_NEAR(to[k], end(row, column), 1e-8);
    }
  }
}

TEST_P(Splines, ScaleWithTime) {
  const Case c = random_case(5, 7);
  std::vector<double> slower = c.durations_s;
  for (double& duration : slower) duration *= 2.5;
  const auto a = spline(GetParam(), c.points, c.durations_s);
  const auto b = spline(GetParam(), c.points, slower);
  for (std::size_t i = 0; i < a.size(); ++i) {
    const Reference fast = evaluate(a[i], 0.3 * a[i].duration_s);
    const Reference slow = evaluate(b[i], 0.3 * b[i].duration_s);
    EXPECT_LT((fast.position_ned - slow.position_ned).norm(), 1e-9);
    EXPECT_LT((fast.velocity_ned - 2.5 * slow.velocity_ned).norm(), 1e-8);
  }
}

TEST(Spline, OfTwoPointsEqualsTheRestToRestPolynomial) {
  const std::vector<PositionYaw> points = {{0, 0, -1, 0.2}, {1.5, -2.0, -0.4, -0.7}};
  const PolynomialSegment jerk = spline(Smoothness::kMinimumJerk, points, {2.5}).front();
  const PolynomialSegment known = minimum_jerk({0, 0, -1}, 0.2, {1.5, -2.0, -0.4}, -0.7, 2.5);
  for (std::size_t i = 0; i < jerk.x.size(); ++i) {
    EXPECT_NEAR(jerk.x[i], known.x[i], 1e-12);
    EXPECT_NEAR(jerk.z[i], known.z[i], 1e-12);
    EXPECT_NEAR(jerk.yaw[i], known.yaw[i], 1e-12);
  }
  Reference from;
  from.position_ned = {0, 0, -1};
  Reference to;
  to.position_ned = {1.5, -2.0, -0.4};
  const PolynomialSegment snap = spline(Smoothness::kMinimumSnap, points, {2.5}).front();
  const PolynomialSegment septic = join(from, to, 2.5);
  for (std::size_t i = 0; i < snap.y.size(); ++i) EXPECT_NEAR(snap.y[i], septic.y[i], 1e-12);
}

// A thousand points with durations from 20 ms to 20 s: the elimination stays accurate.
TEST_P(Splines, AreContinuousWithDurationsOfAnySize) {
  Case c = random_case(6, 1000);
  for (std::size_t i = 0; i < c.durations_s.size(); ++i)
    c.durations_s[i] = 0.02 * std::pow(1000.0, static_cast<double>((i * 7919) % 100) / 99.0);
  const auto segments = spline(GetParam(), c.points, c.durations_s);
  for (std::size_t i = 1; i < segments.size(); ++i) {
    const Reference before = evaluate(segments[i - 1], segments[i - 1].duration_s);
    const Reference after = evaluate(segments[i], 0.0);
    const double size = 1.0 + after.velocity_ned.norm() * 20.0;
    ASSERT_LT((before.position_ned - after.position_ned).norm(), 1e-7 * size) << i;
    ASSERT_LT((before.velocity_ned - after.velocity_ned).norm(), 1e-6 * size) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Costs, Splines, testing::Values(Smoothness::kMinimumJerk, Smoothness::kMinimumSnap),
                         [](const auto& smoothness) {
                           return smoothness.param == Smoothness::kMinimumSnap ? "MinimumSnap"
                                                                               : "MinimumJerk";
                         });

}  // namespace swiftlet::control::spline_test

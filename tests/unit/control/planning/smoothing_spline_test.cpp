#include "swiftlet/control/planning/smoothing_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace swiftlet::control::smoothing_spline_test {

constexpr double kNone = std::numeric_limits<double>::infinity();

// An eight that begins and ends at rest, 12 s.
const std::vector<PolynomialSegment>& eight() {
  static const std::vector<PolynomialSegment> path = spline(Smoothness::kMinimumSnap,
                                                            {{0, 0, -1, 0},
                                                             {1, 0.5, -1.2, 0.5},
                                                             {1.5, 0, -1.4, 1},
                                                             {1, -0.5, -1.2, 0.5},
                                                             {0, 0, -1, 0},
                                                             {-1, 0.5, -0.8, -0.5},
                                                             {-1.5, 0, -0.7, -1},
                                                             {-1, -0.5, -0.8, -0.5},
                                                             {0, 0, -1, 0}},
                                                            std::vector<double>(8, 1.5));
  return path;
}

Reference at(const std::vector<PolynomialSegment>& path, double t_s) {
  std::size_t i = 0;
  while (i + 1 < path.size() && t_s > path[i].duration_s) t_s -= path[i++].duration_s;
  return evaluate(path[i], t_s);
}
double duration_s(const std::vector<PolynomialSegment>& path) {
  double sum = 0.0;
  for (const PolynomialSegment& segment : path) sum += segment.duration_s;
  return sum;
}

double rounded(double value, double digit) { return std::round(value / digit) * digit; }

std::vector<SplineSample> sampled(double rate_hz, double digit) {
  std::vector<SplineSample> samples;
  const int count = static_cast<int>(std::lround(duration_s(eight()) * rate_hz));
  for (int i = 0; i <= count; ++i) {
    const Reference truth = at(eight(), i / rate_hz);
    const PositionYaw exact(truth.position_ned.x(), truth.position_ned.y(), truth.position_ned.z(),
                            truth.yaw_rad);
    samples.push_back({i / rate_hz, 0, exact.unaryExpr([&](double v) { return rounded(v, digit); }),
                       PositionYaw::Constant(0.5 * digit)});
  }
  return samples;
}

struct Extremes {
  double place_m = 0.0, yaw_rad = 0.0, snap = 0.0, true_snap = 0.0;
};
Extremes extremes(const std::vector<PolynomialSegment>& path) {
  Extremes out;
  for (double t_s = 0.0; t_s < duration_s(eight()); t_s += 0.001) {
    const Reference truth = at(eight(), t_s);
    const Reference fitted = at(path, t_s);
    out.place_m = std::max(out.place_m, (fitted.position_ned - truth.position_ned).norm());
    out.yaw_rad = std::max(out.yaw_rad, std::abs(fitted.yaw_rad - truth.yaw_rad));
    out.snap = std::max(out.snap, fitted.snap_ned.norm());
    out.true_snap = std::max(out.true_snap, truth.snap_ned.norm());
  }
  return out;
}

struct Sampling {
  double rate_hz;
  double digit;
};
class SmoothingSpline : public testing::TestWithParam<Sampling> {};

// Rounded to a millimetre at 1,000 Hz, a spline through the samples has snaps of 1e9 m/s^4.
TEST_P(SmoothingSpline, LeavesOutTheRoundingOfSamples) {
  const auto& [rate_hz, digit] = GetParam();
  const std::vector<SplineSample> samples = sampled(rate_hz, digit);
  const SmoothedPath path = smoothing_spline(samples, true, 1024);
  EXPECT_LE(path.tolerance_use, kSmoothingPrecision);
  EXPECT_LE(path.segments.size(), 400U);
  for (const SplineSample& sample : samples) {
    const Reference fitted = at(path.segments, sample.time_s);
    ASSERT_LE((fitted.position_ned - sample.value.head<3>()).cwiseAbs().maxCoeff(), 0.5005 * digit + 1e-12);
    ASSERT_LE(std::abs(fitted.yaw_rad - sample.value[3]), 0.5005 * digit + 1e-12);
  }
  const Extremes found = extremes(path.segments);
  EXPECT_LT(found.place_m, 1.5 * digit);
  EXPECT_LT(found.yaw_rad, 1.5 * digit);
  EXPECT_LT(found.snap, 1.2 * found.true_snap);
}
INSTANTIATE_TEST_SUITE_P(, SmoothingSpline,
                         testing::Values(Sampling{20, 1e-3}, Sampling{20, 1e-6}, Sampling{100, 1e-3},
                                         Sampling{100, 1e-4}, Sampling{100, 1e-6}, Sampling{250, 1e-5},
                                         Sampling{1000, 1e-3}, Sampling{1000, 1e-6}),
                         [](const auto& sampling) {
                           return std::to_string(static_cast<int>(sampling.param.rate_hz)) + "Hz" +
                                  std::to_string(std::lround(-std::log10(sampling.param.digit))) + "Decimals";
                         });

TEST(SmoothingSplines, AreSmoothAndBeginAndEndAtRest) {
  const SmoothedPath path = smoothing_spline(sampled(50, 1e-4), true, 1024);
  for (const Reference& end : {at(path.segments, 0.0), at(path.segments, 100.0)}) {
    EXPECT_LT(end.velocity_ned.norm(), 1e-9);
    EXPECT_LT(end.acceleration_ned.norm(), 1e-7);
  }
  for (std::size_t i = 1; i < path.segments.size(); ++i) {
    const Reference before = evaluate(path.segments[i - 1], path.segments[i - 1].duration_s);
    const Reference after = evaluate(path.segments[i], 0.0);
    ASSERT_LT((after.position_ned - before.position_ned).norm(), 1e-12);
    ASSERT_LT((after.velocity_ned - before.velocity_ned).norm(), 1e-10);
    ASSERT_LT((after.acceleration_ned - before.acceleration_ned).norm(), 1e-8);
    ASSERT_LT((after.jerk_ned - before.jerk_ned).norm(), 1e-6);
    ASSERT_LT((after.snap_ned - before.snap_ned).norm(), 1e-4);
  }
}

// Two samples a second leave the motion between them open; velocities and accelerations say it.
TEST(SmoothingSplines, FollowVelocitiesAndAccelerations) {
  std::vector<SplineSample> places;
  std::vector<SplineSample> all;
  for (int i = 0; i <= 24; ++i) {
    const double t_s = 0.5 * i;
    const Reference truth = at(eight(), t_s);
    const auto sample = [&](int derivative, const Eigen::Vector3d& value, double tolerance) {
      SplineSample out{t_s, derivative, PositionYaw::Zero(), PositionYaw::Constant(tolerance)};
      out.value.head<3>() = value;
      out.tolerance[3] = derivative == 0 ? 0.01 : kNone;
      return out;
    };
    places.push_back(sample(0, truth.position_ned, 1e-6));
    places.back().value[3] = truth.yaw_rad;
    const std::vector<SplineSample> derivatives = {sample(1, truth.velocity_ned, 1e-4),
                                                   sample(2, truth.acceleration_ned, 1e-3)};
    if (i == 24) all.insert(all.end(), derivatives.begin(), derivatives.end());
    all.push_back(places.back());
    if (i < 24) all.insert(all.end(), derivatives.begin(), derivatives.end());
  }
  const SmoothedPath path = smoothing_spline(all, true, 1024);
  EXPECT_LE(path.tolerance_use, kSmoothingPrecision);
  EXPECT_LT(extremes(path.segments).place_m, 1e-3);
  EXPECT_GT(extremes(smoothing_spline(places, true, 1024).segments).place_m,
            3.0 * extremes(path.segments).place_m);
}

TEST(SmoothingSplines, ReportSamplesThatNeedMoreSegments) {
  const std::vector<SplineSample> samples = sampled(100, 1e-6);
  EXPECT_GT(smoothing_spline(samples, true, 10).tolerance_use, 10.0);
  EXPECT_EQ(smoothing_spline(samples, true, 10).segments.size(), 10U);
}

TEST(SmoothingSplines, StandStillExactly) {
  const PositionYaw place(1, 2, -1, 0.3);
  const SmoothedPath path = smoothing_spline(
      {{0.0, 0, place, PositionYaw::Constant(1e-3)}, {4.0, 0, place, PositionYaw::Constant(1e-3)}}, true,
      1024);
  for (const double t_s : {0.0, 1.3, 4.0}) {
    EXPECT_LT((at(path.segments, t_s).position_ned - place.head<3>()).norm(), 1e-8);
    EXPECT_LT(at(path.segments, t_s).velocity_ned.norm(), 1e-8);
  }
}

}  // namespace swiftlet::control::smoothing_spline_test

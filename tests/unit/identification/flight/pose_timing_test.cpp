// Poses with delayed time stamps, of a body with known motion.
#include "swiftlet/identification/flight/pose_timing.hpp"

#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/math/random.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "tests/support/campaign.hpp"

namespace swiftlet::identification::pose_timing_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kDuration_s = 20.0;
constexpr double kImuPeriod_s = 0.002;
constexpr int kPosesEvery = 5;  // samples of the IMU
const Vector3d kGyroOffset(0.02, -0.01, 0.03);

struct Swing {
  double size = 1.0;  // of the rates, rad/s
  Vector3d rates(double t) const {
    return size * Vector3d(1.5 * std::sin(4.4 * t), 1.2 * std::cos(5.6 * t), 0.5 * std::sin(2.3 * t));
  }
};

FlightLog log_of(const Swing& swing, double delay_s, double noise_rad, std::uint64_t seed) {
  constexpr int kSteps = 10;  // of the true attitude, in each period
  math::RandomStream random(seed, 1);
  FlightLog log;
  Quaterniond q = math::rotation({0.1, -0.2, 2.0});
  for (int i = 0; i * kImuPeriod_s < kDuration_s; ++i) {
    const double t = i * kImuPeriod_s;
    log.time_s.push_back(t);
    log.body_rates_frd.push_back(swing.rates(t) + kGyroOffset + 0.5 * noise_rad * random.normal3());
    if (i % kPosesEvery == 0) {
      FlightPose pose;
      pose.time_s = t + delay_s;
      pose.q_ned_from_frd = q * math::rotation(noise_rad * random.normal3());
      log.poses.push_back(pose);
    }
    for (int k = 0; k < kSteps; ++k) {
      const double middle_s = t + (k + 0.5) * kImuPeriod_s / kSteps;
      q = math::renormalised(q * math::rotation(kImuPeriod_s / kSteps * swing.rates(middle_s)));
    }
  }
  return log;
}

// Segments of 0.5 s.
std::vector<Rows> segments_of(const FlightLog& log) {
  std::vector<Rows> out;
  for (std::size_t row = 0; row + 250 <= log.size(); row += 250) out.push_back({row, row + 250});
  return out;
}

TEST(PoseTiming, FindsTheDelayOfExactPoses) {
  for (const double delay_s : {-0.02, 0.0, 0.0031, 0.04}) {
    const FlightLog log = log_of({}, delay_s, 0.0, 1);
    const PoseTiming found = find_pose_timing(log, segments_of(log));
    EXPECT_TRUE(found.identified);
    EXPECT_NEAR(found.delay.value, delay_s, 1e-5);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found.gyro_offset[static_cast<std::size_t>(axis)].value, kGyroOffset[axis], 1e-4);
  }
}

TEST(PoseTiming, IntervalsCoverTheTruth) {
  const int seeds = tests::draws(25, 100);
  constexpr double kDelay_s = 0.007;
  int covered[4] = {};
  double sum_s = 0.0;
  for (int seed = 1; seed <= seeds; ++seed) {
    const FlightLog log = log_of({}, kDelay_s, 0.003, static_cast<std::uint64_t>(seed));
    const PoseTiming found = find_pose_timing(log, segments_of(log));
    EXPECT_TRUE(found.identified);
    sum_s += found.delay.value / seeds;
    const auto holds = [](const ParameterEstimate& e, double truth) {
      return e.low() <= truth && truth <= e.high();
    };
    covered[0] += holds(found.delay, kDelay_s) ? 1 : 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      covered[axis + 1] += holds(found.gyro_offset[axis], kGyroOffset[static_cast<int>(axis)]) ? 1 : 0;
  }
  std::printf("mean delay %.6f s; covered %d, %d, %d, %d of %d\n", sum_s, covered[0], covered[1], covered[2],
              covered[3], seeds);
  EXPECT_NEAR(sum_s, kDelay_s, tests::bound_of_mean(5e-4, seeds));
  for (const int count : covered) EXPECT_GE(count, 0.95 * seeds - 3.2 * seeds * tests::coverage_error(seeds));
}

TEST(PoseTiming, IsNotIdentifiedWithoutRotation) {
  const FlightLog log = log_of({0.0}, 0.01, 0.003, 2);
  EXPECT_FALSE(find_pose_timing(log, segments_of(log)).identified);
}

TEST(PoseTiming, IsNotIdentifiedFromFewPoses) {
  FlightLog log = log_of({}, 0.01, 0.003, 3);
  log.poses.resize(100);
  EXPECT_FALSE(find_pose_timing(log, segments_of(log)).identified);
}

}  // namespace swiftlet::identification::pose_timing_test

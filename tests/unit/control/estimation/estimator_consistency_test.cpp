// Consistency of the filter: errors drawn as it assumes, over many seeds. The bounds of chi-square sums are
// mean +- 5 sqrt(2 n), which a consistent filter exceeds once in a million.
#include <array>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/math/linear_algebra.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/unit/control/estimation/estimator_motion.hpp"
#include "tests/unit/control/estimation/inverse.hpp"

namespace swiftlet::control::estimator_consistency_test {

using Eigen::Vector3d;
using Matrix15 = Eigen::Matrix<double, kErrorStates, kErrorStates>;

constexpr int kSeeds = 60;

struct Case {
  std::int64_t latency_ns;
  int frames;  // IMU samples between poses
};

// Runs for a time and calls on_pose after each pose. Returns the error at the end.
template <class OnPose>
ErrorState run(Estimator& estimator, NoisyMotion& motion, double end_s, const Case& c, OnPose on_pose) {
  for (std::int64_t t = kStep_ns; static_cast<double>(t) * 1e-9 <= end_s; t += kStep_ns) {
    EXPECT_TRUE(estimator.predict(motion.imu(t)));
    const std::int64_t exposed = t - c.latency_ns;
    if (exposed <= 0 || exposed % (c.frames * kStep_ns) != 0) continue;
    EXPECT_TRUE(estimator.correct(motion.pose(exposed))) << to_string(estimator.estimate().pose_fault);
    on_pose();
  }
  return motion.error(estimator.estimate());
}

class Consistency : public testing::TestWithParam<Case> {};

TEST_P(Consistency, ErrorsAndInnovationsMatchTheCovariance) {
  EstimatorSettings settings;
  settings.gate_chi_square = 100.0;
  double nees = 0.0;
  double nis = 0.0;
  int innovations = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Estimator estimator(settings);
    NoisyMotion motion(settings, seed);
    int poses = 0;
    const ErrorState error = run(estimator, motion, 3.0, GetParam(), [&] {
      if (++poses <= 20) return;
      nis += estimator.normalised_innovation();
      ++innovations;
    });
    const Matrix15 covariance = estimator.covariance().matrix();
    nees += error.dot(math::solve_positive_definite(covariance, error).col(0));
  }
  EXPECT_NEAR(nees, 15.0 * kSeeds, 5.0 * std::sqrt(2.0 * 15.0 * kSeeds));
  EXPECT_NEAR(nis, 6.0 * innovations, 5.0 * std::sqrt(2.0 * 6.0 * innovations));
}
INSTANTIATE_TEST_SUITE_P(Streams, Consistency,
                         testing::Values(Case{0, 5}, Case{10'000'000, 5}, Case{30'000'000, 5},
                                         Case{10'000'000, 15}, Case{4'000'000, 1}));

// Half a second without poses: the error matches the covariance and stays small.
TEST(EstimatorConsistency, DeadReckoningErrorMatchesTheCovariance) {
  const EstimatorSettings settings;
  double nees = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    Estimator estimator(settings);
    NoisyMotion motion(settings, 100 + seed);
    run(estimator, motion, 3.0, {10'000'000, 5}, [] {});
    const double before = estimator.standard_deviation()[0];
    for (int i = 0; i < 250; ++i) estimator.predict(motion.imu(estimator.estimate().stamp_ns + kStep_ns));
    const ErrorState error = motion.error(estimator.estimate());
    nees += error.dot(math::solve_positive_definite(estimator.covariance().matrix(), error).col(0));
    EXPECT_GT(estimator.standard_deviation()[0], 10.0 * before);
    EXPECT_LT(error.head<3>().norm(), 0.02) << seed;
  }
  EXPECT_NEAR(nees, 15.0 * kSeeds, 5.0 * std::sqrt(2.0 * 15.0 * kSeeds));
}

TEST(EstimatorConsistency, EstimatesTheBiasesWithinTwoSeconds) {
  const EstimatorSettings settings;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Estimator estimator(settings);
    NoisyMotion motion(settings, 200 + seed);
    const ErrorState error = run(estimator, motion, 2.0, {10'000'000, 5}, [] {});
    EXPECT_LT(error.segment<3>(9).norm(), 2e-3) << seed;
    EXPECT_LT(error.segment<3>(12).norm(), 4e-2) << seed;
    EXPECT_LT(estimator.standard_deviation().segment<3>(9).maxCoeff(), 1e-3);
  }
}

TEST(EstimatorConsistency, CovarianceStaysSymmetricAndPositiveDefinite) {
  const EstimatorSettings settings;
  Estimator estimator(settings);
  NoisyMotion motion(settings, 300);
  const Case stream{10'000'000, 5};
  run(estimator, motion, 120.0, stream, [] {});
  const Matrix15 p = estimator.covariance().matrix();
  EXPECT_EQ(p, p.transpose());
  // In units of its standard deviations, so that metres and radians compare.
  const ErrorState sigma = p.diagonal().cwiseSqrt();
  const Matrix15 correlation = sigma.cwiseInverse().asDiagonal() * p * sigma.cwiseInverse().asDiagonal();
  EXPECT_GT(math::symmetric_eigen(correlation).values[0], 1e-6);
}

// The transition in closed form against the nominal equations, integrated twice: with and without the error.
TEST(EstimatorConsistency, TransitionMatchesTheNominalEquations) {
  const Vector3d rates(0.8, -0.5, 0.3);
  const Vector3d force(1.0, -2.0, -9.0);
  const double duration = 0.02;
  const auto flown = [&](const ErrorState& error) {
    constexpr int kSteps = 2000;
    const double dt = duration / kSteps;
    Vector3d p = error.segment<3>(0);
    Vector3d v = error.segment<3>(3);
    Eigen::Quaterniond q = rotation(error.segment<3>(6));
    for (int i = 0; i < kSteps; ++i) {
      const Eigen::Quaterniond half = rotation(0.5 * dt * (rates - error.segment<3>(9)));
      const Vector3d a = (q * half) * (force - error.segment<3>(12));
      p += dt * v + 0.5 * dt * dt * a;
      v += dt * a;
      q = q * half * half;
    }
    struct {
      Vector3d p, v;
      Eigen::Quaterniond q;
    } out{p, v, q};
    return out;
  };
  const auto nominal = flown(ErrorState::Zero());
  ErrorInterval interval;
  interval.duration_s = duration;
  interval.velocity_change = nominal.v;
  interval.position_change = nominal.p;
  interval.r_ned_from_frd = rotation(0.5 * duration * rates).toRotationMatrix();
  for (int i = 0; i < kErrorStates; ++i) {
    constexpr double kSmall = 1e-5;
    const ErrorState error = kSmall * ErrorState::Unit(i);
    const auto other = flown(error);
    ErrorState moved;
    moved << other.p - nominal.p, other.v - nominal.v, rotation_vector(other.q * nominal.q.conjugate()),
        error.tail<6>();
    EXPECT_LT((advance(interval, error) - moved).norm(), 2e-5 * kSmall) << i;
  }
}

// F P F' + Q and Joseph's form, by dense matrices.
TEST(EstimatorConsistency, CovarianceMatchesTheDenseEquations) {
  ErrorInterval interval;
  interval.duration_s = 0.015;
  interval.velocity_change = {0.02, -0.03, -0.15};
  interval.position_change = {1e-4, -2e-4, -1e-3};
  interval.r_ned_from_frd = rotation({0.3, -0.2, 0.9}).toRotationMatrix();
  const ErrorNoise noise{1e-2, 2e-3, 3e-4, 4e-2};
  Matrix15 f;
  for (int i = 0; i < kErrorStates; ++i) f.col(i) = advance(interval, ErrorState::Unit(i));
  ErrorCovariance covariance;
  covariance.reset(ErrorState::LinSpaced(0.01, 0.4));
  Eigen::Matrix<double, 6, kErrorStates> h = Eigen::Matrix<double, 6, kErrorStates>::Zero();
  h.block<3, 3>(0, 0).setIdentity();
  h.block<3, 3>(3, 6).setIdentity();
  for (int step = 0; step < 5; ++step) {
    const Matrix15 before = covariance.matrix();
    covariance.advance(interval, noise);
    const Matrix15 added = covariance.matrix() - f * before * f.transpose();
    const double t = interval.duration_s;
    ErrorState q;
    q << Vector3d::Constant(noise.velocity * t * t * t / 3), Vector3d::Constant(noise.velocity * t),
        Vector3d::Constant(noise.rotation * t), Vector3d::Constant(noise.gyro_bias * t),
        Vector3d::Constant(noise.accelerometer_bias * t);
    EXPECT_LT((added.diagonal() - q).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_NEAR(added(1, 4), noise.velocity * t * t / 2, 1e-15);

    const Matrix15 p = covariance.matrix();
    Eigen::Matrix<double, 6, 1> v;
    v << Vector3d::Constant(1e-4), Vector3d::Constant(4e-4);
    const Eigen::Matrix<double, 6, 6> s = h * p * h.transpose() + Eigen::Matrix<double, 6, 6>(v.asDiagonal());
    const Eigen::Matrix<double, 6, 6> s_inverse = inverse(s);
    const Eigen::Matrix<double, kErrorStates, 6> k = p * h.transpose() * s_inverse;
    const PoseInnovation innovation{{0.01, -0.02, 0.03}, {-0.02, 0.01, 0.04}};
    Eigen::Matrix<double, 6, 1> z;
    z << innovation.position, innovation.rotation;
    const auto correction = covariance.compute_update(innovation, 1e-4, 4e-4);
    EXPECT_LT((correction.step() - k * z).norm(), 1e-12);
    EXPECT_NEAR(correction.normalised_square(), z.dot(s_inverse * z), 1e-9);
    covariance.apply_update(correction);
    const Matrix15 rest = Matrix15::Identity() - k * h;
    const Matrix15 joseph = rest * p * rest.transpose() + k * v.asDiagonal() * k.transpose();
    EXPECT_LT((covariance.matrix() - joseph).cwiseAbs().maxCoeff(), 1e-14);
  }
}

TEST(EstimatorConsistency, LatePoseCorrectsLikeATimelyOne) {
  const EstimatorSettings settings;
  Estimator in_time(settings);
  Estimator late(settings);
  NoisyMotion a(settings, 400);
  NoisyMotion b(settings, 400);
  run(in_time, a, 3.0, {0, 5}, [] {});
  // The same random samples in the same order; poses delayed by 30 ms.
  std::array<plant::PoseSample, 3> delayed;
  std::uint64_t poses = 0;
  for (std::int64_t t = kStep_ns; t <= 3'000'000'000; t += kStep_ns) {
    late.predict(b.imu(t));
    if (t % kFrame_ns != 0) continue;
    const plant::PoseSample pose = b.pose(t);
    if (poses >= 3) late.correct(delayed[poses % 3]);
    delayed[poses++ % 3] = pose;
  }
  for (int i = 0; i < 3; ++i) late.correct(delayed[(poses + static_cast<std::uint64_t>(i)) % 3]);
  ErrorState difference;
  difference << late.estimate().position_ned - in_time.estimate().position_ned,
      late.estimate().velocity_ned - in_time.estimate().velocity_ned,
      rotation_vector(late.estimate().q_ned_from_frd * in_time.estimate().q_ned_from_frd.conjugate()),
      late.estimate().gyro_bias - in_time.estimate().gyro_bias,
      late.estimate().accelerometer_bias - in_time.estimate().accelerometer_bias;
  const ErrorState sigma = in_time.standard_deviation();
  EXPECT_LT(difference.cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((late.standard_deviation() - sigma).cwiseQuotient(sigma).cwiseAbs().maxCoeff(), 0.02);
}

TEST(EstimatorConsistency, AllocatesNoMemory) {
  const EstimatorSettings settings;
  Estimator estimator(settings);
  NoisyMotion motion(settings, 500);
  run(estimator, motion, 1.0, {10'000'000, 5}, [] {});
  std::size_t calls = 0;
  double sum = 0.0;
  for (int i = 1; i <= 500; ++i) {
    const plant::ImuSample imu = motion.imu(estimator.estimate().stamp_ns + kStep_ns);
    plant::PoseSample pose = motion.pose(imu.stamp_ns - 10'000'000);
    if (i % 7 == 0) pose.position_ned.x() += 3.0;
    const test::MallocGuard guard;
    estimator.predict(imu);
    if (i < 200 || i > 450) estimator.correct(pose);
    sum += estimator.standard_deviation()[0];
    calls += guard.calls();
  }
  EXPECT_EQ(calls, 0U);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace swiftlet::control::estimator_consistency_test

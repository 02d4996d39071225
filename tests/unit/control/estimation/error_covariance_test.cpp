// The covariance against dense matrices of the equations in its header.
#include "swiftlet/control/estimation/error_covariance.hpp"

#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/unit/control/estimation/inverse.hpp"

namespace swiftlet::control::error_covariance_test {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix15 = Eigen::Matrix<double, kErrorStates, kErrorStates>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Selection = Eigen::Matrix<double, 6, kErrorStates>;

Matrix3d hat(const Vector3d& v) {
  return (Matrix3d() << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0).finished();
}

// d position = velocity, d velocity = -f x rotation - R accelerometer_bias, d rotation = -R gyro_bias.
Matrix15 dynamics(const Vector3d& f, const Matrix3d& r) {
  Matrix15 a = Matrix15::Zero();
  a.block<3, 3>(0, 3).setIdentity();
  a.block<3, 3>(3, 6) = -hat(f);
  a.block<3, 3>(3, 12) = -r;
  a.block<3, 3>(6, 9) = -r;
  return a;
}

// e^(A T): the fourth power of A is 0.
Matrix15 transition(const Matrix15& a, double t) {
  return Matrix15::Identity() + t * a + t * t / 2.0 * a * a + t * t * t / 6.0 * a * a * a;
}

ErrorInterval interval_of(const Vector3d& f, const Matrix3d& r, double t) {
  ErrorInterval interval;
  interval.duration_s = t;
  interval.velocity_change = t * f;
  interval.position_change = 0.5 * t * t * f;
  interval.r_ned_from_frd = r;
  return interval;
}

class Covariance : public testing::Test {
 protected:
  Vector3d any(double size) {
    return size * Vector3d(draw_(generator_), draw_(generator_), draw_(generator_));
  }
  ErrorState any_state() {
    return ErrorState::NullaryExpr([this] { return draw_(generator_); });
  }
  Matrix3d any_rotation() { return Eigen::AngleAxisd(2.0, any(1.0).normalized()).toRotationMatrix(); }
  // A covariance with all its correlations, after some intervals and poses.
  ErrorCovariance any_covariance() {
    ErrorCovariance covariance;
    covariance.reset(any_state().cwiseAbs() + ErrorState::Constant(0.1));
    for (int i = 0; i < 5; ++i) {
      covariance.advance(interval_of(any(12.0), any_rotation(), 0.2), {0.01, 0.02, 0.03, 0.04});
      covariance.apply_update(covariance.compute_update({any(0.1), any(0.1)}, 0.5, 0.7));
    }
    return covariance;
  }

  std::mt19937 generator_{6};
  std::uniform_real_distribution<double> draw_{-1.0, 1.0};
};

TEST_F(Covariance, ErrorPropagatesByTheEquations) {
  for (const double t : {0.002, 0.02, 0.1, -0.05}) {
    const Vector3d f = any(12.0);
    const Matrix3d r = any_rotation();
    const ErrorState error = any_state();
    const ErrorState expected = transition(dynamics(f, r), t) * error;
    EXPECT_LT((advance(interval_of(f, r, t), error) - expected).norm(), 1e-14 * (1.0 + expected.norm())) << t;
  }
}

TEST_F(Covariance, PropagatesAndGrowsByTheNoise) {
  const ErrorNoise noise{0.3, 0.5, 0.7, 0.11};
  for (const double t : {0.002, 0.02, 0.1}) {
    ErrorCovariance covariance = any_covariance();
    const Vector3d f = any(12.0);
    const Matrix3d r = any_rotation();
    const Matrix15 step = transition(dynamics(f, r), t);
    Matrix15 expected = step * covariance.matrix() * step.transpose();
    for (int i = 0; i < 3; ++i) {
      expected(i, i) += noise.velocity * t * t * t / 3.0;  // of white noise, integrated twice
      expected(i, 3 + i) += noise.velocity * t * t / 2.0;
      expected(3 + i, i) += noise.velocity * t * t / 2.0;
      expected(3 + i, 3 + i) += noise.velocity * t;
      expected(6 + i, 6 + i) += noise.rotation * t;
      expected(9 + i, 9 + i) += noise.gyro_bias * t;
      expected(12 + i, 12 + i) += noise.accelerometer_bias * t;
    }
    covariance.advance(interval_of(f, r, t), noise);
    EXPECT_LT((covariance.matrix() - expected).norm(), 1e-13 * expected.norm()) << t;
    EXPECT_EQ(covariance.matrix(), covariance.matrix().transpose()) << t;
  }
}

TEST_F(Covariance, IsRestoredByTheReverseInterval) {
  ErrorCovariance covariance = any_covariance();
  const Matrix15 before = covariance.matrix();
  const Vector3d f = any(12.0);
  const Matrix3d r = any_rotation();
  covariance.advance(interval_of(f, r, 0.1), {});
  EXPECT_GT((covariance.matrix() - before).norm(), 1e-3 * before.norm());
  covariance.advance(interval_of(f, r, -0.1), {});
  EXPECT_LT((covariance.matrix() - before).norm(), 1e-12 * before.norm());
}

// K = P H' (H P H' + N)^-1, P+ = (1 - K H) P (1 - K H)' + K N K', with position and rotation measured.
TEST_F(Covariance, FusesAPoseWithTheKalmanGain) {
  for (int trial = 0; trial < 20; ++trial) {
    ErrorCovariance covariance = any_covariance();
    const Matrix15 p = covariance.matrix();
    const double position_variance = 0.02 + trial * 0.01;
    const double rotation_variance = 0.5;
    Selection h = Selection::Zero();
    h.block<3, 3>(0, 0).setIdentity();
    h.block<3, 3>(3, 6).setIdentity();
    Matrix6 n = Matrix6::Zero();
    n.diagonal() << Vector3d::Constant(position_variance), Vector3d::Constant(rotation_variance);
    const Matrix6 s = h * p * h.transpose() + n;
    const Matrix6 s_inverse = inverse(s);
    const Eigen::Matrix<double, kErrorStates, 6> gain = p * h.transpose() * s_inverse;
    const PoseInnovation innovation{any(0.3), any(0.3)};
    Eigen::Matrix<double, 6, 1> nu;
    nu << innovation.position, innovation.rotation;

    const ErrorCovariance::Update correction =
        covariance.compute_update(innovation, position_variance, rotation_variance);
    const double chi_square = nu.dot(s_inverse * nu);
    EXPECT_NEAR(correction.normalised_square(), chi_square, 1e-11 * chi_square);
    EXPECT_LT((correction.step() - gain * nu).norm(), 1e-11);
    EXPECT_EQ(covariance.matrix(), p) << "compute_update() changes nothing";

    covariance.apply_update(correction);
    const Matrix15 rest = Matrix15::Identity() - gain * h;
    const Matrix15 expected = rest * p * rest.transpose() + gain * n * gain.transpose();
    EXPECT_LT((covariance.matrix() - expected).norm(), 1e-11 * p.norm());
    EXPECT_EQ(covariance.matrix(), covariance.matrix().transpose());
  }
}

TEST_F(Covariance, AddsUnmeasuredMotionToTheVariances) {
  ErrorCovariance covariance = any_covariance();
  Matrix15 expected = covariance.matrix();
  for (int i = 0; i < 3; ++i) {
    expected(i, i) += 0.1;
    expected(3 + i, 3 + i) += 0.2;
    expected(6 + i, 6 + i) += 0.3;
  }
  covariance.add_motion(0.1, 0.2, 0.3);
  EXPECT_LT((covariance.matrix() - expected).norm(), 1e-15);
}

TEST_F(Covariance, IsUncorrelatedAfterReset) {
  ErrorCovariance covariance = any_covariance();
  const ErrorState sigma = any_state().cwiseAbs();
  covariance.reset(sigma);
  EXPECT_LT((covariance.matrix() - Matrix15(sigma.cwiseAbs2().asDiagonal())).norm(), 1e-15);
  EXPECT_LT((covariance.standard_deviation() - sigma).norm(), 1e-15);
}

}  // namespace swiftlet::control::error_covariance_test

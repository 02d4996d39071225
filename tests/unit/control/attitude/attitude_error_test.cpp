#include "swiftlet/control/attitude/attitude_error.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/math/euler.hpp"

namespace swiftlet::control::attitude_error_test {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

class AttitudeErrorTest : public testing::Test {
 protected:
  Vector3d any(double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    return {draw(generator_), draw(generator_), draw(generator_)};
  }
  Quaterniond any_attitude() {
    std::normal_distribution<double> draw;
    return Quaterniond(draw(generator_), draw(generator_), draw(generator_), draw(generator_)).normalized();
  }
  std::mt19937 generator_{9};
};

TEST_F(AttitudeErrorTest, EulerAnglesMatchEq3) {
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d euler = any(1.0).cwiseProduct(Vector3d(M_PI, 0.999 * M_PI / 2.0, M_PI));
    const double sp = std::sin(euler[0]), cp = std::cos(euler[0]), st = std::sin(euler[1]),
                 ct = std::cos(euler[1]), ss = std::sin(euler[2]), cs = std::cos(euler[2]);
    Matrix3d r;
    r << ct * cs, sp * st * cs - cp * ss, cp * st * cs + sp * ss,  //
        ct * ss, sp * st * ss + cp * cs, cp * st * ss - sp * cs,   //
        -st, sp * ct, cp * ct;
    const Quaterniond q = math::quaternion_from_euler(euler);
    EXPECT_LT((q.toRotationMatrix() - r).norm(), 1e-14);
    EXPECT_LT((math::euler_angles(q).vector() - euler).norm(), 1e-11);
  }
}

TEST_F(AttitudeErrorTest, EulerAnglesAtTheSingularityRoundTrip) {
  for (const double theta : {M_PI / 2.0, -M_PI / 2.0}) {
    const Quaterniond q = math::quaternion_from_euler({0.4, theta, 0.9});
    const Vector3d euler = math::euler_angles(q).vector();
    EXPECT_EQ(euler[2], 0.0);
    EXPECT_LT(math::quaternion_from_euler(euler).angularDistance(q), 1e-7);
  }
}

TEST_F(AttitudeErrorTest, WrapsAngles) {
  EXPECT_NEAR(math::wrap_angle(2.0 * M_PI + 0.3), 0.3, 1e-15);
  EXPECT_NEAR(math::wrap_angle(-M_PI - 0.1), M_PI - 0.1, 1e-15);
  EXPECT_NEAR(math::wrap_angle(41.0 * M_PI + 0.1), -M_PI + 0.1, 1e-13);
}

TEST_F(AttitudeErrorTest, AttitudeAlongHasTheEulerYaw) {
  for (int trial = 0; trial < 1000; ++trial) {
    const Quaterniond q = math::quaternion_from_euler(any(1.0).cwiseProduct(Vector3d(1.2, 1.2, M_PI)));
    const Matrix3d axes = attitude_along(q * Vector3d::UnitZ(), math::euler_angles(q).vector().z());
    EXPECT_LT((axes - q.toRotationMatrix()).norm(), 1e-13);
  }
}

TEST_F(AttitudeErrorTest, IsZeroAtTheReference) {
  for (int trial = 0; trial < 100; ++trial) {
    const Vector3d euler = any(1.0).cwiseProduct(Vector3d(1.2, 1.2, M_PI));
    const Quaterniond q = math::quaternion_from_euler(euler);
    EXPECT_LT(euler_error(q, q * Vector3d::UnitZ(), euler.z()).norm(), 1e-12);
    const RotationError error = rotation_error(q, q * Vector3d::UnitZ(), euler.z());
    EXPECT_LT(error.angle.norm(), 1e-7);
    EXPECT_LT((error.r_frd_from_reference - Matrix3d::Identity()).norm(), 1e-13);
  }
}

// To first order: the difference is quadratic in the size.
TEST_F(AttitudeErrorTest, EulerAndRotationErrorsAgreeNearLevel) {
  for (const double size : {1e-2, 1e-3}) {
    for (int trial = 0; trial < 100; ++trial) {
      const Quaterniond q = math::quaternion_from_euler(any(size));
      const Vector3d wanted = any(size);
      const Vector3d z = math::quaternion_from_euler(wanted) * Vector3d::UnitZ();
      const Vector3d euler = euler_error(q, z, wanted.z());
      EXPECT_LT((rotation_error(q, z, wanted.z()).angle - euler).norm(), 10.0 * size * size);
    }
  }
}

TEST_F(AttitudeErrorTest, TiltAndYawPartsComposeToTheRotation) {
  for (int trial = 0; trial < 1000; ++trial) {
    const Quaterniond q = any_attitude();
    const Vector3d z = math::quaternion_from_euler(any(1.0)) * Vector3d::UnitZ();
    const double yaw = any(M_PI).x();
    const RotationError error = rotation_error(q, z, yaw);
    EXPECT_NEAR(error.angle.head<2>().norm(), 2.0 * std::sin(0.5 * std::acos(z.dot(q * Vector3d::UnitZ()))),
                1e-7);

    const double tilt = 2.0 * std::asin(std::min(0.5 * error.angle.head<2>().norm(), 1.0));
    const Vector3d axis = Vector3d(error.angle.x(), error.angle.y(), 0.0).normalized();
    const double turn = 2.0 * std::asin(std::clamp(0.5 * error.angle.z(), -1.0, 1.0));
    const Quaterniond reached = q * AngleAxisd(tilt, axis) * AngleAxisd(turn, Vector3d::UnitZ());
    EXPECT_LT((reached.toRotationMatrix() - attitude_along(z, yaw)).norm(), 1e-6);
  }
}

TEST_F(AttitudeErrorTest, IsLargeAndFiniteUpsideDown) {
  for (int trial = 0; trial < 100; ++trial) {
    const Quaterniond q = math::quaternion_from_euler(any(1.0)) * AngleAxisd(M_PI, Vector3d::UnitX());
    const Vector3d z = -(q * Vector3d::UnitZ());
    const RotationError error = rotation_error(q, z, 0.0);
    EXPECT_TRUE(error.angle.allFinite());
    EXPECT_NEAR(error.angle.head<2>().norm(), 2.0, 1e-6);
    EXPECT_LE(std::abs(error.angle.z()), 2.0 + 1e-12);
  }
}

}  // namespace swiftlet::control::attitude_error_test

#include "swiftlet/math/rotation_vector.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::math::rotation_vector_test {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;
using tests::UniformRandom;

// Rodrigues: R = 1 + sin a [n] + (1 - cos a) [n]^2.
Matrix3d rodrigues(const Vector3d& vector) {
  const double angle = vector.norm();
  const Vector3d n = vector / angle;
  Matrix3d hat;
  hat << 0.0, -n.z(), n.y(), n.z(), 0.0, -n.x(), -n.y(), n.x(), 0.0;
  return Matrix3d::Identity() + std::sin(angle) * hat + (1.0 - std::cos(angle)) * hat * hat;
}

Vector3d direction(UniformRandom& draw) {
  return Vector3d(draw(-1.0, 1.0), draw(-1.0, 1.0), draw(-1.0, 1.0)).normalized();
}

// Both sides of the limits of the series, 0.2 rad to a quaternion and 0.063 rad from one.
const double kAngles[] = {1e-9,   1e-5,   1e-3, 0.06, 0.0632, 0.0633, 0.07, 0.19,
                          0.1999, 0.2001, 0.3,  1.0,  2.0,    3.0,    3.14};

TEST(RotationVector, MatchesRodriguesFormula) {
  UniformRandom draw;
  for (const double angle : kAngles) {
    const Vector3d vector = angle * direction(draw);
    const Quaterniond q = rotation(vector);
    EXPECT_NEAR(q.norm(), 1.0, 4e-16) << angle;
    EXPECT_LT((q.toRotationMatrix() - rodrigues(vector)).norm(), 2e-15) << angle;
  }
  EXPECT_EQ(rotation(Vector3d::Zero()).coeffs(), Quaterniond::Identity().coeffs());
}

TEST(RotationVector, IsRecoveredFromTheQuaternion) {
  UniformRandom draw;
  for (const double angle : kAngles) {
    const Vector3d vector = angle * direction(draw);
    const Vector3d axis = vector.normalized();
    const Quaterniond q(std::cos(0.5 * angle), std::sin(0.5 * angle) * axis.x(),
                        std::sin(0.5 * angle) * axis.y(), std::sin(0.5 * angle) * axis.z());
    EXPECT_LT((rotation_vector(q) - vector).norm(), 1e-9 * angle) << angle;
    EXPECT_LT((rotation_vector(Quaterniond(-q.coeffs())) - vector).norm(), 1e-9 * angle) << "-q, " << angle;
  }
  EXPECT_EQ(rotation_vector(Quaterniond::Identity()), Vector3d::Zero());
}

TEST(RotationVector, TakesTheShorterRotation) {
  const Vector3d n(0.6, 0.0, -0.8);
  EXPECT_LT((rotation_vector(rotation(4.0 * n)) - (4.0 - 2.0 * M_PI) * n).norm(), 1e-12);
  EXPECT_LT((rotation_vector(rotation(2.0 * M_PI * n))).norm(), 1e-12);
  EXPECT_NEAR(rotation_vector(Quaterniond(0.0, 0.6, 0.0, -0.8)).norm(), M_PI, 1e-12) << "half a turn";
}

TEST(RotationVector, RenormalisesProductsToUnitLength) {
  Quaterniond q = rotation({0.3, -0.2, 0.5});
  const Quaterniond exact = q;
  q.coeffs() *= 1.0 + 1e-8;
  EXPECT_NEAR(renormalised(q).norm(), 1.0, 1e-15);
  EXPECT_LT((renormalised(q).coeffs() - exact.coeffs()).norm(), 1e-15);
}

}  // namespace swiftlet::math::rotation_vector_test

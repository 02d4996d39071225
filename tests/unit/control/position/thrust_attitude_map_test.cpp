#include "swiftlet/control/position/thrust_attitude_map.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control::thrust_attitude_map_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kMass = 0.04;
constexpr double kTilt = 0.6;
const double kTiltTangent = std::tan(kTilt);
const Vector3d kGravityNed(0.0, 0.0, plant::kGravity);

// Eq. (1) and (5) without drag: the acceleration under this thrust at this attitude.
Vector3d acceleration(const ThrustAttitude& out) {
  return kGravityNed - out.thrust_n / kMass * out.body_z_ned;
}

double tilt(const ThrustAttitude& out) { return std::acos(std::min(out.body_z_ned.z(), 1.0)); }

// Thrust and attitude of a vehicle on the reference.
ThrustAttitude attitude_on(const Reference& r) {
  return thrust_attitude(kMass, r.acceleration_ned, std::tan(1.5));
}

class ThrustAttitudeTest : public testing::Test {
 protected:
  double draw(double size) { return std::uniform_real_distribution<double>(-size, size)(generator_); }
  Vector3d any(double size) { return {draw(size), draw(size), draw(size)}; }
  std::mt19937 generator_{10};
};

TEST_F(ThrustAttitudeTest, GivesTheCommandedAcceleration) {
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d wanted = any(3.0);
    const ThrustAttitude out = thrust_attitude(kMass, wanted, kTiltTangent);
    ASSERT_FALSE(out.limited);
    EXPECT_LT((acceleration(out) - wanted).norm(), 1e-13);
  }
}

TEST_F(ThrustAttitudeTest, HoverIsLevel) {
  const ThrustAttitude out = thrust_attitude(kMass, Vector3d::Zero(), kTiltTangent);
  EXPECT_DOUBLE_EQ(out.thrust_n, kMass * plant::kGravity);
  EXPECT_EQ(out.body_z_ned, Vector3d::UnitZ());
}

TEST_F(ThrustAttitudeTest, ClampsTheTiltAndKeepsTheVerticalPart) {
  int cut = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d wanted = any(1.0).cwiseProduct(Vector3d(30.0, 30.0, 8.0));
    const ThrustAttitude out = thrust_attitude(kMass, wanted, kTiltTangent);
    const Vector3d got = acceleration(out);
    EXPECT_LE(tilt(out), kTilt + 1e-9);
    EXPECT_NEAR(got.z(), wanted.z(), 1e-12);
    if (out.limited) {
      EXPECT_NEAR(tilt(out), kTilt, 1e-9) << "tilted less than it may";
    }
    EXPECT_NEAR(got.x() * wanted.y(), got.y() * wanted.x(), 1e-10) << "the direction is kept";
    EXPECT_GE(got.head<2>().dot(wanted.head<2>()), 0.0);
    EXPECT_EQ(out.limited, (got - wanted).norm() > 1e-9);
    cut += out.limited ? 1 : 0;
  }
  EXPECT_GT(cut, 500);
  EXPECT_LT(cut, 1000);
}

TEST_F(ThrustAttitudeTest, LimitsDownwardAccelerationAndTilt) {
  for (const double down : {0.95 * plant::kGravity, plant::kGravity, 20.0, 1e6}) {
    const ThrustAttitude out = thrust_attitude(kMass, {1.0, -2.0, down}, kTiltTangent);
    EXPECT_TRUE(out.limited);
    EXPECT_LE(tilt(out), kTilt + 1e-9);
    EXPECT_NEAR(acceleration(out).z(), 0.9 * plant::kGravity, 1e-12);
  }
}

TEST_F(ThrustAttitudeTest, InvalidInputGivesHover) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  for (const ThrustAttitude& out : {thrust_attitude(kMass, {nan, 0.0, 0.0}, kTiltTangent),
                                    thrust_attitude(kMass, {0.0, 0.0, -inf}, kTiltTangent)}) {
    EXPECT_TRUE(out.limited);
    EXPECT_DOUBLE_EQ(out.thrust_n, kMass * plant::kGravity);
    EXPECT_EQ(out.body_z_ned, Vector3d::UnitZ());
  }
}

// A segment with large tilt and yaw.
PolynomialSegment lively_segment(std::mt19937& generator) {
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  PolynomialSegment segment;
  segment.duration_s = 1.5;
  for (Polynomial* axis : {&segment.x, &segment.y, &segment.z, &segment.yaw}) {
    double size = 2.0;
    for (std::size_t i = 0; i < axis->size(); ++i) {
      (*axis)[i] = size * draw(generator);
      size /= static_cast<double>(i + 1);  // every derivative is then of about one size
    }
  }
  return segment;
}

TEST_F(ThrustAttitudeTest, ReferenceThrustMatchesTheMap) {
  for (int trial = 0; trial < 50; ++trial) {
    const Reference r = evaluate(lively_segment(generator_), 0.5);
    const ThrustAttitude map = attitude_on(r);
    ASSERT_FALSE(map.limited);
    EXPECT_NEAR(reference_motion(kMass, r, r.yaw_rad).thrust_n, map.thrust_n, 1e-14);
  }
}

TEST_F(ThrustAttitudeTest, ReferenceRatesAgreeWithFiniteDifferences) {
  constexpr double kH = 1e-4;
  double fastest = 0.0;
  for (int trial = 0; trial < 100; ++trial) {
    const PolynomialSegment segment = lively_segment(generator_);
    const auto at = [&](double t) {
      const Reference r = evaluate(segment, t);
      return reference_motion(kMass, r, r.yaw_rad);
    };
    const auto q = [&](double t) {
      const Reference r = evaluate(segment, t);
      return Quaterniond(attitude_along(attitude_on(r).body_z_ned, r.yaw_rad));
    };
    for (const double t : {0.2, 0.5, 0.9}) {
      const ReferenceMotion here = at(t);
      // q(t-h)^-1 q(t+h) turns by 2 h omega.
      const Eigen::AngleAxisd turn(q(t - kH).conjugate() * q(t + kH));
      const double angle = turn.angle() > 3.0 ? turn.angle() - 2.0 * M_PI : turn.angle();
      const Vector3d rates = angle * turn.axis() / (2.0 * kH);
      const double size = 1.0 + here.body_rates.norm();
      EXPECT_LT((here.body_rates - rates).norm(), 1e-5 * size * size * size);
      const Vector3d accelerations = (at(t + kH).body_rates - at(t - kH).body_rates) / (2.0 * kH);
      EXPECT_LT((here.body_accelerations - accelerations).norm(),
                1e-5 * (1.0 + accelerations.norm()) * size * size);
      EXPECT_NEAR(here.thrust_rate, (at(t + kH).thrust_n - at(t - kH).thrust_n) / (2.0 * kH), 1e-5);
      fastest = std::max(fastest, rates.norm());
    }
  }
  EXPECT_GT(fastest, 2.0);
}

TEST_F(ThrustAttitudeTest, FreeFallReferenceHasNoDerivatives) {
  Reference r;
  r.acceleration_ned = {0.0, 0.0, plant::kGravity};
  r.jerk_ned = {1.0, 2.0, 3.0};
  r.snap_ned = {4.0, 5.0, 6.0};
  const ReferenceMotion out = reference_motion(kMass, r, r.yaw_rad);
  EXPECT_NEAR(out.thrust_n, kMinimumLift * kMass * plant::kGravity, 1e-15);
  EXPECT_EQ(out.body_rates, Vector3d::Zero());
  EXPECT_EQ(out.body_accelerations, Vector3d::Zero());
  EXPECT_EQ(out.thrust_rate, 0.0);
}

}  // namespace swiftlet::control::thrust_attitude_map_test

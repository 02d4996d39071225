#include "swiftlet/control/position/position_controller.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "swiftlet/control/types/polynomial.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::position_controller_test {

using Eigen::Vector3d;

constexpr double kStep = 1e-3;

ControlSettings settings(double integral_pole) {
  ControlSettings s;
  s.attitude.roll = s.attitude.pitch = s.attitude.yaw = {Vector3d(625.0, 0.0, 0.0), 1.0};
  s.position.x = {1.5, 0.9, 0.8, integral_pole};
  s.position.y = {1.2, 1.0, 1.0, integral_pole};
  s.position.z = {2.0, 0.8, 1.0, integral_pole};
  return s;
}

PositionController controller(const ControlSettings& s) {
  return PositionController(s.position, s.limits, design(tests::kaylion(), s));
}

// Eq. (41): the ideal vehicle, a double integrator.
struct Point {
  Vector3d position = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();
  void step(const Vector3d& acceleration) {
    position += kStep * velocity + 0.5 * kStep * kStep * acceleration;
    velocity += kStep * acceleration;
  }
};

TEST(PositionController, CommandMatchesEq48) {
  const ControlSettings s = settings(0.0);
  const ControlDesign d = design(tests::kaylion(), s);
  PositionController control(s.position, s.limits, d);
  std::mt19937 generator(9);
  std::uniform_real_distribution<double> draw(-0.3, 0.3);
  const auto any = [&] { return Vector3d(draw(generator), draw(generator), draw(generator)); };
  for (int trial = 0; trial < 100; ++trial) {
    Reference r;
    r.position_ned = any();
    r.velocity_ned = any();
    r.acceleration_ned = any();
    const Vector3d position = any();
    const Vector3d velocity = any();
    const PositionCommand command = control.step(position, velocity, r, kStep, false);
    EXPECT_FALSE(command.limited);
    const Eigen::Matrix<double, 5, 1> f[] = {d.x.f, d.y.f, d.z.f};
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix<double, 5, 1> state;  // Eq. (45)
      state << r.position_ned[i], r.velocity_ned[i], r.acceleration_ned[i], position[i], velocity[i];
      EXPECT_NEAR(command.acceleration_ned[i], f[i].dot(state), 1e-13);
    }
  }
  EXPECT_EQ(control.integral(), Vector3d::Zero());
}

TEST(PositionController, TracksTheReferenceFromItsInitialState) {
  PositionController control = controller(settings(0.0));
  const Trajectory path{0, {minimum_jerk({0, 0, -1}, 0.0, {1.5, -1.0, -1.4}, 0.0, 4.0)}};
  Point point{{0, 0, -1}, {0, 0, 0}};
  for (int i = 0; i < 5000; ++i) {
    const Reference r = evaluate(path.segments[0], i * kStep);
    EXPECT_LT((point.position - r.position_ned).norm(), 2e-3) << "more than the integration error";
    point.step(control.step(point.position, point.velocity, r, kStep, false).acceleration_ned);
  }
}

TEST(PositionController, OnlyTheIntegralRemovesAConstantDisturbance) {
  const Vector3d disturbance(0.3, -0.2, 0.4);
  for (const double integral_pole : {0.0, 0.5}) {
    const ControlSettings s = settings(integral_pole);
    PositionController control = controller(s);
    Point point;
    for (int i = 0; i < 40000; ++i) {
      point.step(control.step(point.position, point.velocity, {}, kStep, false).acceleration_ned +
                 disturbance);
    }
    if (integral_pole > 0.0) {
      EXPECT_LT(point.position.norm(), 1e-5);
      EXPECT_LT((control.integral() + disturbance).norm(), 1e-4);
    } else {
      const RptSettings axes[] = {s.position.x, s.position.y, s.position.z};
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(point.position[i], disturbance[i] / rpt_gains(axes[i]).k_p, 1e-6);
    }
  }
}

TEST(PositionController, IntegralStaysWithinItsLimit) {
  ControlSettings s = settings(0.5);
  s.position.integral_limit = 0.2;
  PositionController control = controller(s);
  Reference r;
  r.position_ned = {0.5, -0.5, 0.5};
  for (int i = 0; i < 10000; ++i) control.step(Vector3d::Zero(), Vector3d::Zero(), r, kStep, false);
  EXPECT_EQ(control.integral(), Vector3d(0.2, -0.2, 0.2));
  control.reset();
  EXPECT_EQ(control.integral(), Vector3d::Zero());
}

TEST(PositionController, IntegralCanBeFrozen) {
  PositionController control = controller(settings(0.5));
  Reference r;
  r.position_ned = {0.5, -0.5, 0.5};
  control.step(Vector3d::Zero(), Vector3d::Zero(), r, kStep, false);
  const Vector3d before = control.integral();
  EXPECT_GT(before.norm(), 0.0);
  for (int i = 0; i < 100; ++i) control.step(Vector3d::Zero(), Vector3d::Zero(), r, kStep, true);
  EXPECT_EQ(control.integral(), before);
}

TEST(PositionController, ClampsToTheLimitsWithoutWindup) {
  const ControlSettings s = settings(0.5);
  PositionController control = controller(s);
  Reference far;
  far.position_ned = {30.0, -40.0, 0.1};
  const PositionCommand command = control.step(Vector3d::Zero(), Vector3d::Zero(), far, kStep, false);
  EXPECT_TRUE(command.limited);
  EXPECT_NEAR(command.acceleration_ned.head<2>().norm(), s.limits.max_acceleration, 1e-12);
  EXPECT_EQ(control.integral().x(), 0.0);
  EXPECT_EQ(control.integral().y(), 0.0);
  EXPECT_GT(control.integral().z(), 0.0);

  far.position_ned = {0.1, 0.0, -50.0};
  control.reset();
  const PositionCommand up = control.step(Vector3d::Zero(), Vector3d::Zero(), far, kStep, false);
  EXPECT_TRUE(up.limited);
  EXPECT_EQ(up.acceleration_ned.z(), -s.limits.max_acceleration);
  EXPECT_GT(control.integral().x(), 0.0);
  EXPECT_EQ(control.integral().z(), 0.0);
}

TEST(PositionController, InvalidInputDoesNotChangeTheIntegral) {
  PositionController control = controller(settings(0.5));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  control.step({nan, 0.0, 0.0}, Vector3d::Zero(), {}, kStep, false);
  EXPECT_EQ(control.integral(), Vector3d::Zero());
  EXPECT_EQ(control.step(Vector3d::Zero(), Vector3d::Zero(), {}, kStep, false).acceleration_ned,
            Vector3d::Zero());
}

}  // namespace swiftlet::control::position_controller_test

#include "control/attitude/attitude_controller.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "tests/unit/plant_model/vehicles.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kPi = 3.14159265358979323846;

ControlSettings settings(AttitudeModel model) {
  ControlSettings s;
  s.attitude.model = model;
  s.attitude.roll = {Vector3d(625.0, 0.0, 0.0), 1.0};
  s.attitude.pitch = {Vector3d(900.0, 1.0, 0.0), 1.0};
  s.attitude.yaw = {Vector3d(25.0, 0.0, 0.0), 1.0};
  return s;
}

// KayLion with a full inertia matrix.
plant::Vehicle skewed() {
  plant::Vehicle vehicle = tests::kaylion();
  vehicle.inertia << 4.4e-5, 3e-6, -2e-6, 3e-6, 4.5e-5, 4e-6, -2e-6, 4e-6, 8.8e-5;
  return vehicle;
}

struct Loops {
  explicit Loops(AttitudeModel model, bool feed_forward = true) : vehicle(skewed()) {
    ControlSettings s = settings(model);
    s.attitude.feed_forward = feed_forward;
    gains = design(vehicle, s);
    controller.emplace(vehicle, s.attitude, gains);
  }
  Vector3d accelerations(const Vector3d& moment, const Vector3d& rates) const {
    return vehicle.inertia.inverse() * (moment - rates.cross(vehicle.inertia * rates));  // Eq. (6)
  }
  plant::Vehicle vehicle;
  ControlDesign gains;
  std::optional<AttitudeController> controller;
};

class AttitudeControllerTest : public testing::Test {
 protected:
  Vector3d any(double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    return {draw(generator_), draw(generator_), draw(generator_)};
  }
  std::mt19937 generator_{8};
};

TEST_F(AttitudeControllerTest, EulerAnglesAreThoseOfEq3) {
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d euler = any(1.0).cwiseProduct(Vector3d(kPi, 0.999 * kPi / 2.0, kPi));
    const double sp = std::sin(euler[0]), cp = std::cos(euler[0]), st = std::sin(euler[1]),
                 ct = std::cos(euler[1]), ss = std::sin(euler[2]), cs = std::cos(euler[2]);
    Matrix3d r;
    r << ct * cs, sp * st * cs - cp * ss, cp * st * cs + sp * ss,  //
        ct * ss, sp * st * ss + cp * cs, cp * st * ss - sp * cs,   //
        -st, sp * ct, cp * ct;
    const Quaterniond q = quaternion_from_euler(euler);
    EXPECT_LT((q.toRotationMatrix() - r).norm(), 1e-14);
    EXPECT_LT((euler_from_quaternion(q) - euler).norm(), 1e-11);
  }
}

TEST_F(AttitudeControllerTest, EulerAnglesAtTheSingularityStillTurnBack) {
  for (const double theta : {kPi / 2.0, -kPi / 2.0}) {
    const Quaterniond q = quaternion_from_euler({0.4, theta, 0.9});
    const Vector3d euler = euler_from_quaternion(q);
    EXPECT_EQ(euler[2], 0.0);
    EXPECT_LT(quaternion_from_euler(euler).angularDistance(q), 1e-7);
  }
}

TEST_F(AttitudeControllerTest, WrapsAngles) {
  EXPECT_NEAR(wrap_angle(2.0 * kPi + 0.3), 0.3, 1e-15);
  EXPECT_NEAR(wrap_angle(-kPi - 0.1), kPi - 0.1, 1e-15);
  EXPECT_NEAR(wrap_angle(41.0 * kPi + 0.1), -kPi + 0.1, 1e-13);
}

TEST_F(AttitudeControllerTest, LinearisesTheDoubleIntegrator) {
  const Loops loops(AttitudeModel::kDoubleIntegrator);
  const Vector3d k1(loops.gains.roll.k[0], loops.gains.pitch.k[0], loops.gains.yaw.k[0]);
  const Vector3d k2(loops.gains.roll.k[1], loops.gains.pitch.k[1], loops.gains.yaw.k[1]);
  for (int trial = 0; trial < 1000; ++trial) {
    const Vector3d euler = any(1.0);
    const Vector3d rates = any(10.0);
    const AttitudeReference reference{any(1.0), any(3.0), any(20.0), any(50.0)};
    const Vector3d moment = loops.controller->moments(euler, rates, any(1.0), reference);
    const Vector3d expected = reference.body_accelerations_frd +
                              k1.cwiseProduct(reference.euler_rad - euler) +
                              k2.cwiseProduct(reference.body_rates_frd - rates);
    EXPECT_LT((loops.accelerations(moment, rates) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
  }
}

TEST_F(AttitudeControllerTest, ClosesTheThirdStateOnThePresentMoment) {
  const Loops loops(AttitudeModel::kMotorLag);
  const Vector3d k3(loops.gains.roll.k[2], loops.gains.pitch.k[2], loops.gains.yaw.k[2]);
  EXPECT_GT(k3.minCoeff(), 0.0);
  const Quaterniond q = quaternion_from_euler({0.1, 0.2, 0.3});
  const Vector3d rates = any(2.0);
  const Vector3d change(1e-4, -2e-4, 5e-5);
  const Vector3d one = loops.controller->moments(euler_from_quaternion(q), rates, Vector3d::Zero(), {});
  const Vector3d other = loops.controller->moments(euler_from_quaternion(q), rates, change, {});
  const Vector3d expected =
      -loops.vehicle.inertia * k3.cwiseProduct(loops.vehicle.inertia.inverse() * change);
  EXPECT_LT((other - one - expected).norm(), 1e-15);
}

TEST_F(AttitudeControllerTest, FeedForwardIsLeftOutWhenNotWanted) {
  const Loops loops(AttitudeModel::kMotorLag, false);
  const Quaterniond q = quaternion_from_euler({0.1, 0.2, 0.3});
  const Vector3d euler(0.3, 0.1, 0.2);
  const Vector3d rates = any(2.0);
  EXPECT_EQ(loops.controller->moments(euler_from_quaternion(q), rates, Vector3d::Zero(),
                                      {euler, any(2.0), any(9.0), any(30.0)}),
            loops.controller->moments(euler_from_quaternion(q), rates, Vector3d::Zero(),
                                      {euler, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}}));
}

TEST_F(AttitudeControllerTest, YawTurnsTheShortWay) {
  const Loops loops(AttitudeModel::kMotorLag);
  AttitudeReference reference;
  reference.euler_rad.z() = -3.0;
  const Vector3d moment =
      loops.controller->moments({0.0, 0.0, 3.0}, Vector3d::Zero(), Vector3d::Zero(), reference);
  const double error = 2.0 * kPi - 6.0;
  EXPECT_NEAR(loops.accelerations(moment, Vector3d::Zero()).z(), loops.gains.yaw.k[0] * error, 1e-9);
}

TEST_F(AttitudeControllerTest, StaysFiniteAndBoundedAtAnyAttitude) {
  const Loops loops(AttitudeModel::kMotorLag);
  const double most =
      (Vector3d(loops.gains.roll.k[0], loops.gains.pitch.k[0], loops.gains.yaw.k[0]) * kPi).norm() *
      loops.vehicle.inertia.norm();
  for (int step = -64; step <= 64; ++step) {
    const double theta = step * kPi / 64.0;  // passes +-90 degrees exactly
    for (const double phi : {-2.0, 0.0, 0.7}) {
      const Quaterniond q = Quaterniond(Eigen::AngleAxisd(theta, Vector3d::UnitY())) *
                            Quaterniond(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
      const Vector3d moment =
          loops.controller->moments(euler_from_quaternion(q), Vector3d::Zero(), Vector3d::Zero(), {});
      ASSERT_TRUE(moment.allFinite()) << "theta " << theta;
      EXPECT_LE(moment.norm(), most);
    }
  }
}

// The rigid body (2), (6) behind the rotor lag, in small steps.
struct Body {
  Quaterniond q = Quaterniond::Identity();
  Vector3d rates = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();
  void step(const Loops& loops, const Vector3d& command, double dt) {
    const Vector3d before = rates;
    rates += dt * loops.accelerations(moment, rates);
    moment += dt / loops.gains.rotor_lag_s * (command - moment);
    const Vector3d turn = 0.5 * dt * (before + rates);
    const double angle = turn.norm();
    if (angle > 0.0) q = q * Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
    q.normalize();
  }
};

TEST_F(AttitudeControllerTest, BringsALargeAttitudeErrorToRest) {
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    const Loops loops(model);
    AttitudeReference reference;
    reference.euler_rad = {-0.2, 0.3, -1.0};
    Body body;
    body.q = quaternion_from_euler({0.6, -0.5, 1.5});
    body.rates = {3.0, -2.0, 1.0};
    constexpr double kStep = 1e-3;
    for (int i = 0; i < 8000; ++i) {
      body.step(loops,
                loops.controller->moments(euler_from_quaternion(body.q), body.rates, body.moment, reference),
                kStep);
    }
    EXPECT_LT(body.q.angularDistance(quaternion_from_euler(reference.euler_rad)), 1e-3);
    EXPECT_LT(body.rates.norm(), 1e-3);
  }
}

TEST_F(AttitudeControllerTest, FeedForwardWithItsDerivativeLeadsTheLag) {
  // Pitch follows 0.3 sin(4 t): behind the lag of 82 ms alone it would be 0.3 rad late in phase.
  const Loops loops(AttitudeModel::kMotorLag);
  const auto worst = [&](bool lead) {
    constexpr double kStep = 5e-4;
    constexpr double kSize = 0.3;
    constexpr double kOmega = 4.0;
    Body body;
    double error = 0.0;
    for (int i = 0; i < 12000; ++i) {
      const double s = kSize * std::sin(kOmega * i * kStep);
      const double c = kSize * std::cos(kOmega * i * kStep);
      AttitudeReference reference;
      reference.euler_rad.y() = s;
      reference.body_rates_frd.y() = kOmega * c;
      reference.body_accelerations_frd.y() = -kOmega * kOmega * s;
      if (lead) reference.body_jerks_frd.y() = -kOmega * kOmega * kOmega * c;
      if (i > 6000) error = std::max(error, std::abs(euler_from_quaternion(body.q).y() - s));
      body.step(loops,
                loops.controller->moments(euler_from_quaternion(body.q), body.rates, body.moment, reference),
                kStep);
    }
    return error;
  };
  EXPECT_LT(worst(true), 2e-3);
  EXPECT_GT(worst(false), 1e-2);
}

TEST_F(AttitudeControllerTest, RefusesAnInertiaThatIsNone) {
  ControlSettings s = settings(AttitudeModel::kMotorLag);
  plant::Vehicle vehicle = tests::kaylion();
  const ControlDesign gains = design(vehicle, s);
  vehicle.inertia(0, 1) = 1e-5;
  EXPECT_THROW(AttitudeController(vehicle, s.attitude, gains), std::invalid_argument);
  vehicle.inertia = -Matrix3d::Identity();
  EXPECT_THROW(AttitudeController(vehicle, s.attitude, gains), std::invalid_argument);
}

}  // namespace
}  // namespace swiftlet::control

#include "swiftlet/control/attitude/attitude_controller.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/math/euler.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

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
  explicit Loops(AttitudeModel model, AttitudeErrorKind error, bool feed_forward = true) : vehicle(skewed()) {
    ControlSettings s = settings(model);
    s.attitude.error = error;
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

AttitudeReference reference_at(const Vector3d& euler) {
  AttitudeReference reference;
  reference.body_z_ned = quaternion_from_euler(euler) * Vector3d::UnitZ();
  reference.heading = euler.z();
  return reference;
}

// For both kinds of error.
class AttitudeControllerTest : public testing::TestWithParam<AttitudeErrorKind> {
 protected:
  Vector3d any(double size) {
    std::uniform_real_distribution<double> draw(-size, size);
    return {draw(generator_), draw(generator_), draw(generator_)};
  }
  std::mt19937 generator_{8};
};
INSTANTIATE_TEST_SUITE_P(Errors, AttitudeControllerTest,
                         testing::Values(AttitudeErrorKind::kEulerAngles, AttitudeErrorKind::kRotation),
                         [](const auto& kind) {
                           return kind.param == AttitudeErrorKind::kRotation ? "Rotation" : "EulerAngles";
                         });

TEST_P(AttitudeControllerTest, LinearisesTheDoubleIntegrator) {
  const Loops loops(AttitudeModel::kDoubleIntegrator, GetParam());
  const Vector3d k1(loops.gains.roll.k[0], loops.gains.pitch.k[0], loops.gains.yaw.k[0]);
  const Vector3d k2(loops.gains.roll.k[1], loops.gains.pitch.k[1], loops.gains.yaw.k[1]);
  for (int trial = 0; trial < 1000; ++trial) {
    const Quaterniond q = quaternion_from_euler(any(1.0));
    const Vector3d rates = any(10.0);
    AttitudeReference reference = reference_at(any(1.0));
    reference.body_rates = any(3.0);
    reference.body_accelerations = any(20.0);
    reference.body_jerks = any(50.0);
    Vector3d error = euler_error(q, reference.body_z_ned, reference.heading.yaw_rad);
    Matrix3d turn = Matrix3d::Identity();
    if (GetParam() == AttitudeErrorKind::kRotation) {
      const RotationError rotation = rotation_error(q, reference.body_z_ned, reference.heading);
      error = rotation.angle;
      turn = rotation.r_frd_from_reference;
    }
    const Vector3d moment = loops.controller->moments(q, rates, any(1.0), reference);
    const Vector3d expected = turn * reference.body_accelerations + k1.cwiseProduct(error) +
                              k2.cwiseProduct(turn * reference.body_rates - rates);
    EXPECT_LT((loops.accelerations(moment, rates) - expected).norm(), 1e-9 * (1.0 + expected.norm()));
  }
}

TEST_P(AttitudeControllerTest, ClosesTheThirdStateOnThePresentMoment) {
  const Loops loops(AttitudeModel::kMotorLag, GetParam());
  const Vector3d k3(loops.gains.roll.k[2], loops.gains.pitch.k[2], loops.gains.yaw.k[2]);
  EXPECT_GT(k3.minCoeff(), 0.0);
  const Quaterniond q = quaternion_from_euler({0.1, 0.2, 0.3});
  const Vector3d rates = any(2.0);
  const Vector3d change(1e-4, -2e-4, 5e-5);
  const Vector3d one = loops.controller->moments(q, rates, Vector3d::Zero(), {});
  const Vector3d other = loops.controller->moments(q, rates, change, {});
  const Vector3d expected =
      -loops.vehicle.inertia * k3.cwiseProduct(loops.vehicle.inertia.inverse() * change);
  EXPECT_LT((other - one - expected).norm(), 1e-15);
}

TEST_P(AttitudeControllerTest, FeedForwardIsLeftOutWhenNotWanted) {
  const Loops loops(AttitudeModel::kMotorLag, GetParam(), false);
  const Quaterniond q = quaternion_from_euler({0.1, 0.2, 0.3});
  const Vector3d rates = any(2.0);
  const AttitudeReference still = reference_at({0.3, 0.1, 0.2});
  AttitudeReference moving = still;
  moving.body_rates = any(2.0);
  moving.body_accelerations = any(9.0);
  moving.body_jerks = any(30.0);
  EXPECT_EQ(loops.controller->moments(q, rates, Vector3d::Zero(), moving),
            loops.controller->moments(q, rates, Vector3d::Zero(), still));
}

TEST_P(AttitudeControllerTest, YawTurnsTheShortWay) {
  const Loops loops(AttitudeModel::kMotorLag, GetParam());
  const Vector3d moment = loops.controller->moments(quaternion_from_euler({0.0, 0.0, 3.0}), Vector3d::Zero(),
                                                    Vector3d::Zero(), reference_at({0.0, 0.0, -3.0}));
  const double angle = 2.0 * M_PI - 6.0;
  const double error = GetParam() == AttitudeErrorKind::kRotation ? 2.0 * std::sin(0.5 * angle) : angle;
  EXPECT_NEAR(loops.accelerations(moment, Vector3d::Zero()).z(), loops.gains.yaw.k[0] * error, 1e-9);
}

TEST_P(AttitudeControllerTest, StaysFiniteAndBoundedAtAnyAttitude) {
  const Loops loops(AttitudeModel::kMotorLag, GetParam());
  const double most =
      (Vector3d(loops.gains.roll.k[0], loops.gains.pitch.k[0], loops.gains.yaw.k[0]) * M_PI).norm() *
      loops.vehicle.inertia.norm();
  for (int step = -64; step <= 64; ++step) {
    const double theta = step * M_PI / 64.0;  // passes +-90 degrees exactly
    for (const double phi : {-2.0, 0.0, 0.7}) {
      const Quaterniond q = Quaterniond(Eigen::AngleAxisd(theta, Vector3d::UnitY())) *
                            Quaterniond(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
      const Vector3d moment = loops.controller->moments(q, Vector3d::Zero(), Vector3d::Zero(), {});
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

TEST_P(AttitudeControllerTest, BringsALargeAttitudeErrorToRest) {
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    const Loops loops(model, GetParam());
    const Vector3d wanted(-0.2, 0.3, -1.0);
    const AttitudeReference reference = reference_at(wanted);
    Body body;
    body.q = quaternion_from_euler({0.6, -0.5, 1.5});
    body.rates = {3.0, -2.0, 1.0};
    constexpr double kStep = 1e-3;
    for (int i = 0; i < 8000; ++i) {
      body.step(loops, loops.controller->moments(body.q, body.rates, body.moment, reference), kStep);
    }
    EXPECT_LT(body.q.angularDistance(quaternion_from_euler(wanted)), 1e-3);
    EXPECT_LT(body.rates.norm(), 1e-3);
  }
}

TEST_P(AttitudeControllerTest, FeedForwardWithItsDerivativeLeadsTheLag) {
  // Pitch follows 0.3 sin(4 t): behind the lag of 82 ms alone it would be 0.3 rad late in phase.
  const Loops loops(AttitudeModel::kMotorLag, GetParam());
  const auto worst = [&](bool lead) {
    constexpr double kStep = 5e-4;
    constexpr double kSize = 0.3;
    constexpr double kOmega = 4.0;
    Body body;
    double error = 0.0;
    for (int i = 0; i < 12000; ++i) {
      const double s = kSize * std::sin(kOmega * i * kStep);
      const double c = kSize * std::cos(kOmega * i * kStep);
      AttitudeReference reference = reference_at({0.0, s, 0.0});
      reference.body_rates.y() = kOmega * c;
      reference.body_accelerations.y() = -kOmega * kOmega * s;
      if (lead) reference.body_jerks.y() = -kOmega * kOmega * kOmega * c;
      if (i > 6000) error = std::max(error, std::abs(euler_angles(body.q).vector().y() - s));
      body.step(loops, loops.controller->moments(body.q, body.rates, body.moment, reference), kStep);
    }
    return error;
  };
  EXPECT_LT(worst(true), 2e-3);
  EXPECT_GT(worst(false), 1e-2);
}

// Pitching through the vertical, the Euler angles phi and psi jump by half a turn.
TEST(AttitudeController, OnlyTheRotationKnowsNoJump) {
  const auto largest_jump = [](AttitudeErrorKind kind) {
    const Loops loops(AttitudeModel::kMotorLag, kind);
    const AttitudeReference reference = reference_at({0.0, 0.0, 0.5});
    const double scale = loops.vehicle.inertia.norm() * loops.gains.roll.k[0];
    double largest = 0.0;
    for (const double phi : {-0.4, 0.0, 0.3}) {
      const auto moment = [&](double theta) {
        const Quaterniond q = Quaterniond(Eigen::AngleAxisd(theta, Vector3d::UnitY())) *
                              Quaterniond(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
        return loops.controller->moments(q, Vector3d::Zero(), Vector3d::Zero(), reference);
      };
      constexpr double kStep = 1e-3;
      for (double theta = -2.5; theta < 2.5; theta += kStep)
        largest = std::max(largest, (moment(theta + kStep) - moment(theta)).norm() / scale);
    }
    return largest;
  };
  EXPECT_LT(largest_jump(AttitudeErrorKind::kRotation), 0.01);
  EXPECT_GT(largest_jump(AttitudeErrorKind::kEulerAngles), 1.0);
}

TEST(AttitudeController, RefusesAnInertiaThatIsNone) {
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

#include "swiftlet/control/attitude/attitude_controller.hpp"

#include <cmath>
#include <optional>
#include <random>
#include <stdexcept>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "swiftlet/math/euler.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::attitude_controller_test {

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

struct ControlledVehicle {
  explicit ControlledVehicle(AttitudeModel model, AttitudeErrorKind error, bool feed_forward = true)
      : vehicle(skewed()) {
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
  reference.body_z_ned = math::quaternion_from_euler(euler) * Vector3d::UnitZ();
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

// The control law from rotation matrices, Eq. (3), and half angles, without the code's error functions.
struct Law {
  AttitudeModel model;
  AttitudeErrorKind error;
  Matrix3d inertia;
  double lag_s;
  Vector3d k_angle, k_rate, k_acceleration;

  // Euler angles of the rotation matrix: r31 = -s theta, r32 / r33 = t phi, r21 / r11 = t psi.
  static Vector3d euler_of(const Matrix3d& r) {
    return {std::atan2(r(2, 1), r(2, 2)), -std::asin(r(2, 0)), std::atan2(r(1, 0), r(0, 0))};
  }
  Vector3d angle_error(const Matrix3d& r_ned_from_frd, const Vector3d& euler_r) const {
    const Matrix3d r_ned_from_reference = matrix_of(euler_r);
    if (error == AttitudeErrorKind::kEulerAngles) {
      // b is the z axis of the reference, in axes of the present heading.
      const Vector3d euler = euler_of(r_ned_from_frd);
      const Vector3d b = Eigen::AngleAxisd(-euler.z(), Vector3d::UnitZ()) * r_ned_from_reference.col(2);
      const Vector3d wanted(-std::asin(b.y()), std::atan2(b.x(), b.z()), euler_r.z());
      return (wanted - euler).unaryExpr([](double angle) { return std::remainder(angle, 2.0 * M_PI); });
    }
    const Matrix3d missing = r_ned_from_frd.transpose() * r_ned_from_reference;
    const Vector3d z = missing.col(2);
    const Vector3d across = Vector3d::UnitZ().cross(z);
    const double tilt = std::atan2(across.norm(), z.z());
    const Vector3d axis = across.normalized();
    const Matrix3d after_tilt = Eigen::AngleAxisd(-tilt, axis).toRotationMatrix() * missing;  // about z alone
    const double yaw = std::atan2(after_tilt(1, 0), after_tilt(0, 0));
    return 2.0 * std::sin(0.5 * tilt) * axis + 2.0 * std::sin(0.5 * yaw) * Vector3d::UnitZ();
  }
  // The moment for a commanded angular acceleration by Eq. (6).
  Vector3d moment(const Vector3d& command, const Vector3d& rates, const Vector3d& present_moment,
                  const Vector3d& accelerations_r) const {
    const Vector3d gyroscopic = rates.cross(inertia * rates);
    Vector3d wanted = command;
    if (model == AttitudeModel::kMotorLag)
      wanted +=
          k_acceleration.asDiagonal() * (accelerations_r - inertia.inverse() * (present_moment - gyroscopic));
    return inertia * wanted + gyroscopic;
  }
  static Matrix3d matrix_of(const Vector3d& euler) {
    return (Eigen::AngleAxisd(euler.z(), Vector3d::UnitZ()) *
            Eigen::AngleAxisd(euler.y(), Vector3d::UnitY()) * Eigen::AngleAxisd(euler.x(), Vector3d::UnitX()))
        .toRotationMatrix();
  }
};

Law law_of(const ControlledVehicle& controlled, AttitudeModel model, AttitudeErrorKind error) {
  const ControlDesign& g = controlled.gains;
  return {model,
          error,
          controlled.vehicle.inertia,
          0.0821,  // tau_m
          {g.roll.k[0], g.pitch.k[0], g.yaw.k[0]},
          {g.roll.k[1], g.pitch.k[1], g.yaw.k[1]},
          {g.roll.k[2], g.pitch.k[2], g.yaw.k[2]}};
}

// Large angles, body rates, a present moment and all feed-forward terms.
TEST_P(AttitudeControllerTest, MomentsMatchTheControlLaw) {
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    const ControlledVehicle controlled(model, GetParam());
    const Law law = law_of(controlled, model, GetParam());
    for (int trial = 0; trial < 1000; ++trial) {
      const Vector3d euler = any(1.0).cwiseProduct(Vector3d(1.0, 1.0, 3.0));
      const Vector3d euler_r = any(1.0).cwiseProduct(Vector3d(1.0, 1.0, 3.0));
      const Vector3d rates = any(10.0);
      const Vector3d present = any(2e-3);
      AttitudeReference reference;
      reference.body_z_ned = Law::matrix_of(euler_r).col(2);
      reference.heading = euler_r.z();
      reference.body_rates = any(3.0);
      reference.body_accelerations = any(20.0);

      const Matrix3d r = Law::matrix_of(euler);
      const bool turns = GetParam() == AttitudeErrorKind::kRotation;
      const Matrix3d turn = turns ? Matrix3d(r.transpose() * Law::matrix_of(euler_r)) : Matrix3d::Identity();
      const Vector3d accelerations_r = turn * reference.body_accelerations;
      const Vector3d command = accelerations_r + law.k_angle.cwiseProduct(law.angle_error(r, euler_r)) +
                               law.k_rate.cwiseProduct(turn * reference.body_rates - rates);
      const Vector3d expected = law.moment(command, rates, present, accelerations_r);
      const Vector3d found = controlled.controller->moments(Quaterniond(r), rates, present, reference);
      ASSERT_LT((found - expected).norm(), 1e-7 * expected.norm()) << "trial " << trial;
    }
  }
}

TEST_P(AttitudeControllerTest, MomentsForRatesMatchTheRateLaw) {
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    const ControlledVehicle controlled(model, GetParam());
    const Law law = law_of(controlled, model, GetParam());
    for (int trial = 0; trial < 100; ++trial) {
      const Vector3d rates = any(10.0);
      const Vector3d wanted = any(10.0);
      const Vector3d present = any(2e-3);
      const Vector3d expected =
          law.moment(law.k_rate.cwiseProduct(wanted - rates), rates, present, Vector3d::Zero());
      ASSERT_LT((controlled.controller->moments_for_rates(rates, present, wanted) - expected).norm(),
                1e-12 * expected.norm());
    }
  }
}

// The double integrator's LQR in closed form, Q = diag(q1, q2) and R = 1:
// K = [sqrt(q1), sqrt(q2 + 2 sqrt(q1))].
TEST_P(AttitudeControllerTest, SmallErrorsOfEachAxisUseItsGains) {
  const ControlledVehicle controlled(AttitudeModel::kDoubleIntegrator, GetParam());
  const Vector3d k_angle(25.0, 30.0, 5.0);
  const Vector3d k_rate(std::sqrt(50.0), std::sqrt(61.0), std::sqrt(10.0));
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d unit = Vector3d::Unit(axis);
    const Quaterniond turned(Eigen::AngleAxisd(1e-5, unit));
    const Vector3d angle_moment = controlled.controller->moments(turned, Vector3d::Zero(), Vector3d::Zero(),
                                                                 reference_at(Vector3d::Zero()));
    EXPECT_LT((angle_moment + controlled.vehicle.inertia * (1e-5 * k_angle[axis] * unit)).norm(),
              1e-9 * angle_moment.norm())
        << axis;
    const Vector3d rate_moment = controlled.controller->moments(
        Quaterniond::Identity(), 1e-5 * unit, Vector3d::Zero(), reference_at(Vector3d::Zero()));
    EXPECT_LT((rate_moment + controlled.vehicle.inertia * (1e-5 * k_rate[axis] * unit)).norm(),
              1e-4 * rate_moment.norm())
        << axis;
  }
}

TEST_P(AttitudeControllerTest, FeedForwardCanBeDisabled) {
  const ControlledVehicle controlled(AttitudeModel::kMotorLag, GetParam(), false);
  const Quaterniond q = math::quaternion_from_euler({0.1, 0.2, 0.3});
  const Vector3d rates = any(2.0);
  const AttitudeReference still = reference_at({0.3, 0.1, 0.2});
  AttitudeReference moving = still;
  moving.body_rates = any(2.0);
  moving.body_accelerations = any(9.0);
  EXPECT_EQ(controlled.controller->moments(q, rates, Vector3d::Zero(), moving),
            controlled.controller->moments(q, rates, Vector3d::Zero(), still));
}

TEST_P(AttitudeControllerTest, YawTurnsTheShorterWay) {
  const ControlledVehicle controlled(AttitudeModel::kMotorLag, GetParam());
  const Vector3d moment =
      controlled.controller->moments(math::quaternion_from_euler({0.0, 0.0, 3.0}), Vector3d::Zero(),
                                     Vector3d::Zero(), reference_at({0.0, 0.0, -3.0}));
  const double angle = 2.0 * M_PI - 6.0;
  const double error = GetParam() == AttitudeErrorKind::kRotation ? 2.0 * std::sin(0.5 * angle) : angle;
  EXPECT_NEAR(controlled.accelerations(moment, Vector3d::Zero()).z(), controlled.gains.yaw.k[0] * error,
              1e-9);
}

TEST_P(AttitudeControllerTest, StaysFiniteAndBoundedAtAnyAttitude) {
  const ControlledVehicle controlled(AttitudeModel::kMotorLag, GetParam());
  const double most =
      (Vector3d(controlled.gains.roll.k[0], controlled.gains.pitch.k[0], controlled.gains.yaw.k[0]) * M_PI)
          .norm() *
      controlled.vehicle.inertia.norm();
  for (int step = -64; step <= 64; ++step) {
    const double theta = step * M_PI / 64.0;  // passes +-90 degrees exactly
    for (const double phi : {-2.0, 0.0, 0.7}) {
      const Quaterniond q = Quaterniond(Eigen::AngleAxisd(theta, Vector3d::UnitY())) *
                            Quaterniond(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
      const Vector3d moment = controlled.controller->moments(q, Vector3d::Zero(), Vector3d::Zero(), {});
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
  void step(const ControlledVehicle& controlled, const Vector3d& command, double dt) {
    const Vector3d before = rates;
    rates += dt * controlled.accelerations(moment, rates);
    moment += dt / controlled.gains.rotor_lag_s * (command - moment);
    const Vector3d turn = 0.5 * dt * (before + rates);
    const double angle = turn.norm();
    if (angle > 0.0) q = q * Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
    q.normalize();
  }
};

TEST_P(AttitudeControllerTest, BringsALargeAttitudeErrorToRest) {
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    const ControlledVehicle controlled(model, GetParam());
    const Vector3d wanted(-0.2, 0.3, -1.0);
    const AttitudeReference reference = reference_at(wanted);
    Body body;
    body.q = math::quaternion_from_euler({0.6, -0.5, 1.5});
    body.rates = {3.0, -2.0, 1.0};
    constexpr double kStep = 1e-3;
    for (int i = 0; i < 8000; ++i) {
      body.step(controlled, controlled.controller->moments(body.q, body.rates, body.moment, reference),
                kStep);
    }
    EXPECT_LT(body.q.angularDistance(math::quaternion_from_euler(wanted)), 1e-3);
    EXPECT_LT(body.rates.norm(), 1e-3);
  }
}

// Pitching through the vertical, the Euler angles phi and psi jump by half a turn.
TEST(AttitudeController, OnlyTheRotationErrorIsContinuous) {
  const auto largest_jump = [](AttitudeErrorKind kind) {
    const ControlledVehicle controlled(AttitudeModel::kMotorLag, kind);
    const AttitudeReference reference = reference_at({0.0, 0.0, 0.5});
    const double scale = controlled.vehicle.inertia.norm() * controlled.gains.roll.k[0];
    double largest = 0.0;
    for (const double phi : {-0.4, 0.0, 0.3}) {
      const auto moment = [&](double theta) {
        const Quaterniond q = Quaterniond(Eigen::AngleAxisd(theta, Vector3d::UnitY())) *
                              Quaterniond(Eigen::AngleAxisd(phi, Vector3d::UnitX()));
        return controlled.controller->moments(q, Vector3d::Zero(), Vector3d::Zero(), reference);
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

TEST(AttitudeController, RefusesAnInvalidInertia) {
  ControlSettings s = settings(AttitudeModel::kMotorLag);
  plant::Vehicle vehicle = tests::kaylion();
  const ControlDesign gains = design(vehicle, s);
  vehicle.inertia(0, 1) = 1e-5;
  EXPECT_THROW(AttitudeController(vehicle, s.attitude, gains), std::invalid_argument);
  vehicle.inertia = -Matrix3d::Identity();
  EXPECT_THROW(AttitudeController(vehicle, s.attitude, gains), std::invalid_argument);
}

// GIVEN any attitude and reference WHEN the body turns with the rates of rates() THEN moments() asks for the gyroscopic
// moment alone.
TEST_P(AttitudeControllerTest, RatesAreThoseAtWhichTheLawAsksForNoMoment) {
  const ControlledVehicle vehicle(AttitudeModel::kDoubleIntegrator, GetParam());
  for (int i = 0; i < 100; ++i) {
    AttitudeReference reference = reference_at(any(0.5));
    reference.body_rates = any(1.0);
    const Quaterniond q = math::quaternion_from_euler(any(0.5));
    const Vector3d rates = vehicle.controller->rates(q, reference);
    const Vector3d moment = vehicle.controller->moments(q, rates, Vector3d::Zero(), reference);
    EXPECT_LT((moment - rates.cross(vehicle.vehicle.inertia * rates)).norm(), 1e-12);
  }
}

}  // namespace swiftlet::control::attitude_controller_test

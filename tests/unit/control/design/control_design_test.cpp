#include "swiftlet/control/design/control_design.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

#include "swiftlet/math/angles.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::control_design_test {

using Eigen::Vector3d;

constexpr double kLag = 0.0821;

LqrWeights weights(double q1, double q2 = 0.0, double q3 = 0.0, double r = 1.0) {
  return {Vector3d(q1, q2, q3), r};
}

ControlSettings settings(AttitudeModel model) {
  ControlSettings s;
  s.attitude.model = model;
  s.attitude.roll = s.attitude.pitch = weights(625.0);
  s.attitude.yaw = weights(25.0);
  return s;
}

// The phase margin by a dense scan for gain crossovers.
double scanned_margin_deg(const Loop& loop) {
  double margin = std::numeric_limits<double>::infinity();
  double before = std::log(std::abs(frequency_response(loop, 1e-3)));
  for (int i = 0; i < 16000; ++i) {
    const double omega = 1e-3 * std::exp(1e-3 * i);  // to 9e3 rad/s
    const std::complex<double> response = frequency_response(loop, omega);
    const double gain = std::log(std::abs(response));
    const double here = std::arg(-response) * math::kDegPerRad;
    if ((gain > 0.0) != (before > 0.0) && std::abs(here) < std::abs(margin)) margin = here;
    before = gain;
  }
  return margin;
}

TEST(AttitudeDesign, MatchesTheDoubleIntegratorAnchors) {
  const AttitudeAxisDesign slow =
      design_attitude_axis(AttitudeModel::kDoubleIntegrator, weights(625.0), kLag);
  EXPECT_NEAR(slow.k[0], 25.0, 1e-10);
  EXPECT_NEAR(slow.k[1], std::sqrt(50.0), 1e-10);
  EXPECT_EQ(slow.k[2], 0.0);
  EXPECT_NEAR(slow.phase_margin_deg, 33.0, 0.5);

  const AttitudeAxisDesign fast = design_attitude_axis(AttitudeModel::kDoubleIntegrator, weights(1e4), kLag);
  EXPECT_NEAR(fast.k[0], 100.0, 1e-9);
  EXPECT_NEAR(fast.k[1], std::sqrt(200.0), 1e-9);
  EXPECT_NEAR(fast.phase_margin_deg, 15.0, 0.5);
}

TEST(AttitudeDesign, MatchesTheMotorLagAnchor) {
  const AttitudeAxisDesign axis = design_attitude_axis(AttitudeModel::kMotorLag, weights(625.0), kLag);
  EXPECT_NEAR(axis.k[0], 25.0, 5e-3);
  EXPECT_NEAR(axis.k[1], 8.85, 5e-3);
  EXPECT_NEAR(axis.k[2], 0.566, 5e-4);
  EXPECT_NEAR(axis.phase_margin_deg, 64.0, 0.5);
}

TEST(AttitudeDesign, MotorLagKeepsTheLqrMargin) {
  // Kalman's inequality: an LQR loop cut at its one input keeps 60 degrees, whatever the weights.
  std::mt19937 generator(4);
  std::uniform_real_distribution<double> exponent(-2.0, 5.0);
  for (int trial = 0; trial < 200; ++trial) {
    const auto any = [&] { return std::pow(10.0, exponent(generator)); };
    const AttitudeAxisDesign axis = design_attitude_axis(
        AttitudeModel::kMotorLag, weights(any(), 0.01 * any(), 1e-4 * any(), any()), kLag);
    EXPECT_GE(axis.phase_margin_deg, 60.0 - 1e-6);
    EXPECT_LT(axis.poles.back().real(), 0.0);
  }
}

TEST(AttitudeDesign, PolesMatchTheDesignModel) {
  const AttitudeAxisDesign axis =
      design_attitude_axis(AttitudeModel::kDoubleIntegrator, weights(625.0), kLag);
  ASSERT_EQ(axis.poles.size(), 2U);
  for (const std::complex<double>& s : axis.poles)
    EXPECT_LT(std::abs(s * s + axis.k[1] * s + axis.k[0]), 1e-9);
  ASSERT_EQ(axis.poles_with_lag.size(), 3U);
  for (const std::complex<double>& s : axis.poles_with_lag) {
    EXPECT_LT(std::abs(s * s * (kLag * s + 1.0) + axis.k[1] * s + axis.k[0]), 1e-9);
  }
  EXPECT_EQ(design_attitude_axis(AttitudeModel::kMotorLag, weights(625.0), kLag).poles.size(), 3U);
}

TEST(LoopMargin, AgreesWithADenseScan) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> exponent(-1.0, 1.0);
  for (int trial = 0; trial < 10; ++trial) {
    const auto about = [&](double v) { return v * std::pow(10.0, exponent(generator)); };
    const Vector3d k(about(40.0), about(8.0), about(0.3));
    const RptGains gains{about(1.0), about(1.5), about(0.1)};
    for (const Loop& loop : {attitude_loop(k, {kLag}), horizontal_position_loop(gains, k, {kLag}),
                             vertical_position_loop(gains, {kLag})}) {
      EXPECT_NEAR(phase_margin_deg(loop), scanned_margin_deg(loop), 0.1) << "trial " << trial;
    }
  }
}

TEST(LoopMargin, FindsEveryCrossover) {
  // 2/(s+1) crosses once; a resonance above it lifts the gain through one twice more.
  Loop loop{Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3), Eigen::RowVectorXd::Zero(3)};
  loop.a << -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -100.0, -0.1;
  loop.b << 2.0, 0.0, 20.0;
  loop.c << 1.0, 1.0, 0.0;
  const std::vector<double> found = crossovers(loop);
  ASSERT_EQ(found.size(), 3U);
  for (const double omega : found) EXPECT_NEAR(std::abs(frequency_response(loop, omega)), 1.0, 1e-12);
  loop.b *= 0.01;
  loop.c[1] = 0.0;
  EXPECT_TRUE(crossovers(loop).empty());
  EXPECT_EQ(phase_margin_deg(loop), std::numeric_limits<double>::infinity());
}

TEST(RptDesign, FeedbackFollowsTheOrderOfTheState) {
  const RptSettings s{1.5, 0.8, 0.5, 0.0};
  const Eigen::Matrix<double, 5, 1> f = rpt_feedback(s);
  EXPECT_DOUBLE_EQ(f[0], 9.0);  // omega_n^2 / epsilon^2
  EXPECT_DOUBLE_EQ(f[1], 4.8);  // 2 zeta omega_n / epsilon
  EXPECT_DOUBLE_EQ(f[2], 1.0);
  EXPECT_DOUBLE_EQ(f[3], -9.0);
  EXPECT_DOUBLE_EQ(f[4], -4.8);
  const RptGains gains = rpt_gains(s);
  EXPECT_DOUBLE_EQ(gains.k_p, 9.0);
  EXPECT_DOUBLE_EQ(gains.k_v, 4.8);
  EXPECT_EQ(gains.k_i, 0.0);
}

TEST(RptDesign, IntegralFormPlacesThePoles) {
  // (s^2 + 2 zeta w/e s + w^2/e^2) (s + integral_pole/e), on the double integrator of Eq. (41).
  const RptSettings s{2.0, 0.9, 0.7, 0.4};
  const RptGains g = rpt_gains(s);
  const auto error = [&](std::complex<double> p) {
    return std::abs(p * p * p + g.k_v * p * p + g.k_p * p + g.k_i);
  };
  const double w = s.omega_n / s.epsilon;
  EXPECT_LT(error(-s.integral_pole / s.epsilon), 1e-12);
  EXPECT_LT(error({-s.zeta * w, w * std::sqrt(1.0 - s.zeta * s.zeta)}), 1e-12);
}

TEST(RptDesign, MarginMatchesTheInnerLoopAnchors) {
  const Vector3d k(25.0, std::sqrt(50.0), 0.0);
  const auto margin = [&](double omega_n) {
    return phase_margin_deg(horizontal_position_loop(rpt_gains({omega_n, 1.0, 1.0, 0.0}), k, {kLag}));
  };
  EXPECT_NEAR(margin(1.0), 43.0, 0.5);
  EXPECT_NEAR(margin(2.0), 4.5, 0.2);
}

TEST(ControlDesign, CoversAllAxes) {
  const plant::Vehicle& vehicle = tests::kaylion();
  for (const AttitudeModel model : {AttitudeModel::kDoubleIntegrator, AttitudeModel::kMotorLag}) {
    ControlSettings s = settings(model);
    s.position.z.integral_pole = 0.3;
    const ControlDesign d = design(vehicle, s);
    EXPECT_EQ(d.rotor_lag_s, vehicle.motor.time_constant_s);
    EXPECT_EQ(d.roll.model, model);
    EXPECT_NEAR(d.yaw.k[0], 5.0, 1e-9);
    EXPECT_EQ(d.x.gains.k_i, 0.0);
    EXPECT_GT(d.z.gains.k_i, 0.0);
    EXPECT_EQ(d.x.poles.size(), 5U);
    EXPECT_EQ(d.z.poles.size(), 4U);
    EXPECT_TRUE(unstable_loops(d).empty());
  }
}

TEST(ControlDesign, NamesUnstableLoops) {
  // s^2 (tau s + 1) + k2 s + k1 is stable only for k2 > tau k1 (Routh): 40^2 is past that.
  ControlSettings s = settings(AttitudeModel::kDoubleIntegrator);
  s.attitude.pitch = weights(std::pow(40.0 * 40.0, 2));
  s.position.y.omega_n = 3.0;
  const std::vector<plant::Violation> found = unstable_loops(design(tests::kaylion(), s));
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].key, "attitude.pitch");
  EXPECT_EQ(found[1].key, "position.x");  // acts through pitch
  EXPECT_EQ(found[2].key, "position.y");
}

TEST(ControlDesign, RefusesInvalidSettings) {
  const plant::Vehicle& vehicle = tests::kaylion();
  const auto refuses = [&](auto change) {
    ControlSettings s = settings(AttitudeModel::kMotorLag);
    change(s);
    EXPECT_THROW(design(vehicle, s), std::invalid_argument);
  };
  refuses([](ControlSettings& s) { s.attitude.roll.q[0] = 0.0; });
  refuses([](ControlSettings& s) { s.attitude.pitch.q[2] = -1.0; });
  refuses([](ControlSettings& s) { s.attitude.yaw.r = 0.0; });
  refuses([](ControlSettings& s) { s.attitude.yaw.q[1] = std::nan(""); });
  refuses([](ControlSettings& s) { s.position.x.epsilon = 0.0; });
  refuses([](ControlSettings& s) { s.position.z.integral_pole = -0.1; });
  plant::Vehicle without_lag = vehicle;
  without_lag.motor.time_constant_s = 0.0;
  EXPECT_THROW(design(without_lag, settings(AttitudeModel::kMotorLag)), std::invalid_argument);
}

}  // namespace swiftlet::control::control_design_test

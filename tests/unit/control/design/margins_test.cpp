// Gain, phase and delay margins against closed forms and against the loop at its stability limit.
#include "swiftlet/control/design/margins.hpp"

#include <cmath>
#include <complex>

#include <gtest/gtest.h>

#include "swiftlet/control/design/control_design.hpp"

namespace swiftlet::control::margins_test {

// k / (s (s + 1) (s + 2)): crosses -180 degrees at sqrt(2) rad/s, where its gain is k / 6.
Loop third_order(double k) {
  Loop loop{Eigen::MatrixXd::Zero(3, 3), Eigen::VectorXd::Zero(3), Eigen::RowVectorXd::Zero(3)};
  loop.a << 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -2.0, -3.0;
  loop.b[2] = 1.0;
  loop.c[0] = k;
  return loop;
}

Loop roll_loop(double lag_s) {
  const AttitudeAxisDesign axis =
      design_attitude_axis(AttitudeModel::kMotorLag, {Eigen::Vector3d(40000.0, 0.0, 0.0), 1.0}, 0.08);
  return attitude_loop(axis.k, {lag_s});
}

double rightmost_pole(Loop loop, double gain) {
  loop.c *= gain;
  return closed_loop_poles(loop).back().real();
}

TEST(Margins, MatchTheClosedForm) {
  const std::vector<double> crossings = phase_crossovers(third_order(2.0));
  ASSERT_EQ(crossings.size(), 1U);
  EXPECT_NEAR(crossings.front(), std::sqrt(2.0), 1e-9);
  const LoopMargins m = margins(third_order(2.0));
  EXPECT_NEAR(m.gain_increase, 3.0, 1e-9);
  EXPECT_EQ(m.gain_decrease, 0.0);
  const double omega = crossovers(third_order(2.0)).front();
  EXPECT_NEAR(m.delay_s, m.phase_deg * M_PI / 180.0 / omega, 1e-12);
  EXPECT_NEAR(m.phase_deg, 180.0 - 90.0 - (std::atan(omega) + std::atan(omega / 2.0)) * 180.0 / M_PI, 1e-9);
}

TEST(Margins, OfAnUnstableLoopAreZero) {
  const LoopMargins m = margins(third_order(7.0));
  EXPECT_LE(m.phase_deg, 0.0);
  EXPECT_EQ(m.gain_increase, 1.0);
  EXPECT_EQ(m.gain_decrease, 1.0);
  EXPECT_EQ(m.delay_s, 0.0);
}

// A position loop with an integral over the attitude loop is unstable with too much and with too little gain.
TEST(Margins, EndWherePolesReachTheImaginaryAxis) {
  RptSettings settings;
  settings.omega_n = 2.0;
  settings.zeta = 1.0;
  settings.epsilon = 1.0;
  settings.integral_pole = 0.4;
  const AttitudeAxisDesign axis =
      design_attitude_axis(AttitudeModel::kMotorLag, {Eigen::Vector3d(40000.0, 0.0, 0.0), 1.0}, 0.08);
  const Loop loop = horizontal_position_loop(rpt_gains(settings), axis.k, {0.08});
  const LoopMargins m = margins(loop);
  ASSERT_TRUE(std::isfinite(m.gain_increase));
  ASSERT_GT(m.gain_decrease, 0.0);
  EXPECT_LT(rightmost_pole(loop, 0.999 * m.gain_increase), 0.0);
  EXPECT_GT(rightmost_pole(loop, 1.001 * m.gain_increase), 0.0);
  EXPECT_LT(rightmost_pole(loop, 1.001 * m.gain_decrease), 0.0);
  EXPECT_GT(rightmost_pole(loop, 0.999 * m.gain_decrease), 0.0);
}

// The delay is a Pade approximation of order 2, accurate this far below its corner.
TEST(Margins, DelayMarginIsTheLimitOfStability) {
  const Loop loop = roll_loop(0.08);
  const LoopMargins m = margins(loop);
  const auto delayed = [&](double delay_s) {
    const double t = delay_s;
    // (t^2 s^2 - 6 t s + 12) / (t^2 s^2 + 6 t s + 12) = 1 - 12 t s / (t^2 s^2 + 6 t s + 12)
    const Eigen::Index n = loop.a.rows();
    Loop out{Eigen::MatrixXd::Zero(n + 2, n + 2), Eigen::VectorXd::Zero(n + 2),
             Eigen::RowVectorXd::Zero(n + 2)};
    out.a.topLeftCorner(n, n) = loop.a;
    out.a.block(0, n + 1, n, 1) = loop.b * (-12.0 / t);
    out.a(n, n + 1) = 1.0;
    out.a(n + 1, n) = -12.0 / (t * t);
    out.a(n + 1, n + 1) = -6.0 / t;
    out.b.head(n) = loop.b;
    out.b[n + 1] = 1.0;
    out.c.head(n) = loop.c;
    return closed_loop_poles(out).back().real();
  };
  EXPECT_LT(delayed(0.98 * m.delay_s), 0.0);
  EXPECT_GT(delayed(1.02 * m.delay_s), 0.0);
}

TEST(Margins, OfAnLqrOnItsModelSatisfyKalmansInequality) {
  const LoopMargins m = margins(roll_loop(0.08));
  EXPECT_GE(m.phase_deg, 60.0);
  EXPECT_LE(m.gain_decrease, 0.5);
  EXPECT_TRUE(std::isinf(m.gain_increase));
}

}  // namespace swiftlet::control::margins_test

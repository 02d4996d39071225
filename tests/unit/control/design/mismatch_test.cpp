#include "swiftlet/control/design/mismatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "tests/support/paths.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::mismatch_test {

using tests::kaylion;

constexpr double kSupply = 4.0;

const ControlDesign& motor_lag() {
  static const ControlDesign made =
      design(kaylion(), io::load_control_settings(tests::in_source("config/control/motor_lag.yaml")));
  return made;
}

using Complex = std::complex<double>;
using Response = std::function<Complex(Complex s)>;

// The loops as explicit transfer functions: gain / (tau s + 1) times the feedback of angle = a / s^2,
// rate = a / s and acceleration, which the observer scales to `observed` a.
Response attitude_response(const Eigen::Vector3d& k, double lag_s, double gain, double observed) {
  return [=](Complex s) { return gain / (lag_s * s + 1.0) * (k[0] / (s * s) + k[1] / s + k[2] * observed); };
}
Complex outer_gains(const RptGains& gains, Complex s) {
  return gains.k_p / (s * s) + gains.k_v / s + gains.k_i / (s * s * s);
}
// The command leads the observed thrust: around the rotors alone there is a loop of `lead` times what is observed.
Response vertical_response(const RptGains& gains, double lag_s, double gain, double observed = 1.0) {
  const double lead = motor_lag().thrust_lead;
  return [=](Complex s) {
    const Complex rotors = gain / (lag_s * s + 1.0);
    return (1.0 + lead) * rotors / (1.0 + lead * observed * rotors) * outer_gains(gains, s);
  };
}
// Over the closed attitude loop, from the commanded angle, with gain k[0], to the angle.
Response horizontal_response(const RptGains& gains, const Eigen::Vector3d& k, double lag_s, double gain,
                             double observed, double tilt_gain = 1.0) {
  const Response inner = attitude_response(k, lag_s, gain, observed);
  return [=](Complex s) {
    const Complex angle = k[0] * gain / (lag_s * s + 1.0) / (s * s) / (1.0 + inner(s));
    return tilt_gain * angle * outer_gains(gains, s);
  };
}

// The least phase margin of all crossings of |L| = 1, found on a grid and by bisection.
double margin_of(const Response& response) {
  const auto log_gain = [&](double x) { return std::log(std::abs(response(Complex(0.0, std::exp(x))))); };
  constexpr double kGrid = 1e-3;
  double margin = std::numeric_limits<double>::infinity();
  for (double x = std::log(1e-3); x < std::log(1e4); x += kGrid) {
    double low = x;
    double high = x + kGrid;
    if ((log_gain(low) > 0.0) == (log_gain(high) > 0.0)) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      ((log_gain(middle) > 0.0) == (log_gain(low) > 0.0) ? low : high) = middle;
    }
    const double here = std::arg(-response(Complex(0.0, std::exp(low)))) * 180.0 / M_PI;
    if (std::abs(here) < std::abs(margin)) margin = here;
  }
  return margin;
}

std::array<double, 6> margins(const plant::Vehicle& flown) {
  const PhaseMargins m = margins_on(motor_lag(), kaylion(), flown, kSupply);
  return {m.roll, m.pitch, m.yaw, m.x, m.y, m.z};
}

TEST(Mismatch, KeepsTheDesignMarginsOnTheDesignVehicle) {
  const ControlDesign& d = motor_lag();
  const std::array<double, 6> expected = {d.roll.phase_margin_deg, d.pitch.phase_margin_deg,
                                          d.yaw.phase_margin_deg,  d.x.phase_margin_deg,
                                          d.y.phase_margin_deg,    d.z.phase_margin_deg};
  const std::array<double, 6> found = margins(kaylion());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Mismatch, NominalMarginsMatchTheTransferFunctions) {
  const ControlDesign& d = motor_lag();
  const double lag = 0.0821;
  const std::array<double, 6> expected = {margin_of(attitude_response(d.roll.k, lag, 1.0, 1.0)),
                                          margin_of(attitude_response(d.pitch.k, lag, 1.0, 1.0)),
                                          margin_of(attitude_response(d.yaw.k, lag, 1.0, 1.0)),
                                          margin_of(horizontal_response(d.x.gains, d.pitch.k, lag, 1.0, 1.0)),
                                          margin_of(horizontal_response(d.y.gains, d.roll.k, lag, 1.0, 1.0)),
                                          margin_of(vertical_response(d.z.gains, lag, 1.0))};
  const std::array<double, 6> found = margins(kaylion());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Mismatch, MotorLagChangesTheLagOfTheLoops) {
  plant::Vehicle slow = kaylion();
  slow.motor.time_constant_s *= 1.5;
  const double lag = 1.5 * 0.0821;
  const ControlDesign& d = motor_lag();
  const std::array<double, 6> found = margins(slow);
  EXPECT_NEAR(found[0], margin_of(attitude_response(d.roll.k, lag, 1.0, 1.0)), 1e-6);
  EXPECT_NEAR(found[2], margin_of(attitude_response(d.yaw.k, lag, 1.0, 1.0)), 1e-6);
  EXPECT_NEAR(found[3], margin_of(horizontal_response(d.x.gains, d.pitch.k, lag, 1.0, 1.0)), 1e-6);
  EXPECT_NEAR(found[5], margin_of(vertical_response(d.z.gains, lag, 1.0)), 1e-6);
  EXPECT_LT(found[0], margins(kaylion())[0]);
}

TEST(Mismatch, InertiaDividesTheGainAndScalesTheObservedMoment) {
  plant::Vehicle heavy = kaylion();
  heavy.inertia *= 1.4;
  const ControlDesign& d = motor_lag();
  const double lag = 0.0821;
  EXPECT_NEAR(margins(heavy)[0], margin_of(attitude_response(d.roll.k, lag, 1.0 / 1.4, 1.4)), 1e-6);
  EXPECT_NEAR(margins(heavy)[2], margin_of(attitude_response(d.yaw.k, lag, 1.0 / 1.4, 1.4)), 1e-6);
  EXPECT_NEAR(margins(heavy)[4], margin_of(horizontal_response(d.y.gains, d.roll.k, lag, 1.0 / 1.4, 1.4)),
              1e-6);
  EXPECT_NEAR(margins(heavy)[5], margins(kaylion())[5], 1e-6) << "the vertical loop has no moment";
}

TEST(Mismatch, MassChangesThePositionLoopsOnly) {
  plant::Vehicle heavy = kaylion();
  heavy.mass_kg *= 1.25;
  const ControlDesign& d = motor_lag();
  const double lag = 0.0821;
  const std::array<double, 6> found = margins(heavy);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], margins(kaylion())[i], 1e-6) << i;
  EXPECT_NEAR(found[3], margin_of(horizontal_response(d.x.gains, d.pitch.k, lag, 1.0, 1.0, 1.0 / 1.25)),
              1e-6);
  EXPECT_NEAR(found[5], margin_of(vertical_response(d.z.gains, lag, 1.0 / 1.25, 1.25)), 1e-6);
}

// The thrust that results from a commanded one: Eq. (25), (22) and (9) with the controller's vehicle, then
// (9), (22) and (25) with the vehicle flown.
double thrust_of(const plant::Vehicle& flown, double commanded_n) {
  const plant::Vehicle& known = kaylion();
  const double speed_c = std::sqrt(commanded_n / known.rotor.thrust);
  const double v_c = known.motor.k2 * speed_c + known.motor.k3 * speed_c * speed_c;
  const double throttle = (v_c * v_c - known.esc.offset_v2) / (known.esc.gain * kSupply * kSupply);
  const double v_a = std::sqrt(flown.esc.gain * kSupply * kSupply * throttle + flown.esc.offset_v2);
  const double root = std::sqrt(flown.motor.k2 * flown.motor.k2 + 4.0 * flown.motor.k3 * v_a);
  const double speed = (root - flown.motor.k2) / (2.0 * flown.motor.k3);
  return flown.rotor.thrust * speed * speed;
}

TEST(Mismatch, PropulsionScalesTheGainByTheThrustSlope) {
  plant::Vehicle flown = kaylion();
  flown.motor.k2 *= 0.93;
  flown.motor.k3 *= 1.06;
  flown.rotor.thrust *= 1.05;
  flown.rotor.torque *= 0.96;
  flown.esc.gain *= 0.97;
  flown.esc.offset_v2 *= 1.2;
  double commanded = 0.05;  // of one rotor in hover, by bisection
  for (double step = 0.05; step > 1e-15; step *= 0.5)
    commanded += thrust_of(flown, commanded) < flown.mass_kg * plant::kGravity / 4.0 ? step : -step;
  const double slope = (thrust_of(flown, commanded + 1e-6) - thrust_of(flown, commanded - 1e-6)) / 2e-6;

  const ControlDesign& d = motor_lag();
  const double lag = 0.0821;
  const std::array<double, 6> found = margins(flown);
  EXPECT_NEAR(found[0], margin_of(attitude_response(d.roll.k, lag, slope, 1.0 / 1.05)), 1e-4);
  EXPECT_NEAR(found[2], margin_of(attitude_response(d.yaw.k, lag, slope * 0.96 / 1.05, 1.0 / 0.96)), 1e-4);
  EXPECT_NEAR(found[5], margin_of(vertical_response(d.z.gains, lag, slope, 1.0 / 1.05)), 1e-4);
  const double tilt_gain = kaylion().mass_kg * plant::kGravity / (4.0 * commanded);
  EXPECT_NEAR(found[3],
              margin_of(horizontal_response(d.x.gains, d.pitch.k, lag, slope, 1.0 / 1.05, tilt_gain)), 1e-4);
}

TEST(Mismatch, UnstableLoopsHaveNoMargin) {
  plant::Vehicle slow = kaylion();
  slow.motor.time_constant_s *= 20.0;
  const std::array<double, 6> found = margins(slow);
  EXPECT_LE(*std::min_element(found.begin(), found.end()), 0.0);
}

}  // namespace swiftlet::control::mismatch_test

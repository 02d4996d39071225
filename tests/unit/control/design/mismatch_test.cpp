#include "swiftlet/control/design/mismatch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/plant/model/esc.hpp"
#include "swiftlet/plant/model/motor.hpp"
#include "swiftlet/plant/model/rotor.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control {
namespace {

using tests::kaylion;

constexpr double kSupply = 4.0;

const ControlDesign& motor_lag() {
  static const ControlDesign made =
      design(kaylion(), runtime::load_control_settings(SWIFTLET_SOURCE_DIR "/config/control/motor_lag.yaml"));
  return made;
}

std::array<double, 6> margins(const plant::Vehicle& flown) {
  const PhaseMargins m = margins_on(motor_lag(), kaylion(), flown, kSupply);
  return {m.roll, m.pitch, m.yaw, m.x, m.y, m.z};
}

TEST(Mismatch, IsNoneOnTheVehicleOfTheDesign) {
  const ControlDesign& d = motor_lag();
  const std::array<double, 6> expected = {d.roll.phase_margin_deg, d.pitch.phase_margin_deg,
                                          d.yaw.phase_margin_deg,  d.x.phase_margin_deg,
                                          d.y.phase_margin_deg,    d.z.phase_margin_deg};
  const std::array<double, 6> found = margins(kaylion());
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(found[i], expected[i], 1e-6) << i;
}

TEST(Mismatch, OfTheLagAloneIsTheLoopWithThatLag) {
  plant::Vehicle slow = kaylion();
  slow.motor.time_constant_s *= 1.5;
  const RotorResponse response{slow.motor.time_constant_s};
  const ControlDesign& d = motor_lag();
  const std::array<double, 6> found = margins(slow);
  EXPECT_NEAR(found[0], phase_margin_deg(attitude_loop(d.roll.k, response)), 1e-6);
  EXPECT_NEAR(found[3], phase_margin_deg(horizontal_position_loop(d.x.gains, d.pitch.k, response)), 1e-6);
  EXPECT_NEAR(found[5], phase_margin_deg(vertical_position_loop(d.z.gains, response)), 1e-6);
  EXPECT_LT(found[0], margins(kaylion())[0]);
}

TEST(Mismatch, OfTheInertiaDividesTheMomentAndMultipliesWhatIsSeenOfIt) {
  plant::Vehicle heavy = kaylion();
  heavy.inertia *= 1.4;
  const RotorResponse response{heavy.motor.time_constant_s, 1.0 / 1.4, 1.4};
  EXPECT_NEAR(margins(heavy)[0], phase_margin_deg(attitude_loop(motor_lag().roll.k, response)), 1e-6);
  EXPECT_NEAR(margins(heavy)[2], phase_margin_deg(attitude_loop(motor_lag().yaw.k, response)), 1e-6);
  EXPECT_NEAR(margins(heavy)[5], margins(kaylion())[5], 1e-6) << "the vertical loop has no moment";
}

TEST(Mismatch, OfTheMassTouchesThePositionAlone) {
  plant::Vehicle heavy = kaylion();
  heavy.mass_kg *= 1.25;
  const ControlDesign& d = motor_lag();
  const double lag = d.rotor_lag_s;
  const std::array<double, 6> found = margins(heavy);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i], margins(kaylion())[i], 1e-6) << i;
  EXPECT_NEAR(found[3], phase_margin_deg(horizontal_position_loop(d.x.gains, d.pitch.k, {lag}, 1.0 / 1.25)),
              1e-6);
  EXPECT_NEAR(found[5], phase_margin_deg(vertical_position_loop(d.z.gains, {lag, 1.0 / 1.25})), 1e-6);
}

// The thrust that comes of a commanded one, by the model's own functions.
double thrust_of(const plant::Vehicle& flown, double commanded_n) {
  const plant::Vehicle& designed = kaylion();
  const double v_c =
      plant::voltage_from_steady_speed(designed.motor, plant::speed_from_thrust(designed.rotor, commanded_n));
  const double throttle = plant::throttle_from_motor_voltage(designed.esc, kSupply, v_c);
  const double v_a = plant::motor_voltage(flown.esc, kSupply, throttle);
  return plant::thrust_from_speed(flown.rotor, plant::steady_speed_from_voltage(flown.motor, v_a));
}

TEST(Mismatch, OfMotorRotorAndEscIsTheSlopeOfTheirThrust) {
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
  const double lag = d.rotor_lag_s;
  const std::array<double, 6> found = margins(flown);
  EXPECT_NEAR(found[0], phase_margin_deg(attitude_loop(d.roll.k, {lag, slope, 1.0 / 1.05})), 1e-4);
  EXPECT_NEAR(found[2], phase_margin_deg(attitude_loop(d.yaw.k, {lag, slope * 0.96 / 1.05, 1.0 / 0.96})),
              1e-4);
  EXPECT_NEAR(found[5], phase_margin_deg(vertical_position_loop(d.z.gains, {lag, slope})), 1e-4);
  const double tilt_gain = kaylion().mass_kg * plant::kGravity / (4.0 * commanded);
  const RotorResponse pitch{lag, slope, 1.0 / 1.05};
  EXPECT_NEAR(found[3], phase_margin_deg(horizontal_position_loop(d.x.gains, d.pitch.k, pitch, tilt_gain)),
              1e-4);
}

TEST(Mismatch, LeavesNoMarginToALoopThatIsNotStable) {
  plant::Vehicle slow = kaylion();
  slow.motor.time_constant_s *= 20.0;
  const std::array<double, 6> found = margins(slow);
  EXPECT_LE(*std::min_element(found.begin(), found.end()), 0.0);
}

}  // namespace
}  // namespace swiftlet::control

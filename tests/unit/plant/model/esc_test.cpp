#include "swiftlet/plant/model/esc.hpp"

#include <limits>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::esc_test {

using tests::kaylion;
using tests::UniformRandom;

TEST(Esc, PulseWidthMatchesEquation8) {
  const Esc& esc = kaylion().esc;
  EXPECT_DOUBLE_EQ(throttle_from_pulse_width(esc, 1039.0), 0.0);
  EXPECT_DOUBLE_EQ(throttle_from_pulse_width(esc, 1289.0), 0.25);
  EXPECT_DOUBLE_EQ(throttle_from_pulse_width(esc, 2039.0), 1.0);
  EXPECT_DOUBLE_EQ(pulse_width_from_throttle(esc, 0.25), 1289.0);
}

TEST(Esc, VoltageMatchesEquation9) {
  const Esc& esc = kaylion().esc;
  EXPECT_NEAR(motor_voltage(esc, 4.19, 0.5), std::sqrt(0.9205 * 4.19 * 4.19 * 0.5 + 0.6472), 1e-14);
  EXPECT_NEAR(motor_voltage(esc, 3.7, 0.0), 0.804, 5e-4);  // the intercept
  EXPECT_NEAR(motor_voltage(esc, 4.19, 0.1), 1.5, 0.01);   // where Fig. 2 starts
}

TEST(Esc, PulseWidthInvertsThrottle) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double throttle = draw(0.0, 1.0);
    EXPECT_NEAR(throttle_from_pulse_width(kaylion().esc, pulse_width_from_throttle(kaylion().esc, throttle)),
                throttle, 1e-12);
  }
}

TEST(Esc, VoltageInvertsThrottle) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double supply = draw(3.0, 4.3);
    const double throttle = draw(0.0, 1.0);
    const double voltage = motor_voltage(kaylion().esc, supply, throttle);
    EXPECT_NEAR(throttle_from_motor_voltage(kaylion().esc, supply, voltage), throttle, 1e-12);
  }
}

TEST(Esc, ClampsUnreachableValues) {
  const Esc& esc = kaylion().esc;
  EXPECT_EQ(throttle_from_pulse_width(esc, 500.0), 0.0);
  EXPECT_EQ(throttle_from_pulse_width(esc, 9000.0), 1.0);
  EXPECT_EQ(motor_voltage(esc, 3.7, -1.0), motor_voltage(esc, 3.7, 0.0));
  EXPECT_EQ(motor_voltage(esc, 3.7, 2.0), motor_voltage(esc, 3.7, 1.0));
  EXPECT_EQ(throttle_from_motor_voltage(esc, 3.7, 0.8), 0.0);   // below the intercept
  EXPECT_EQ(throttle_from_motor_voltage(esc, 3.7, -3.0), 0.0);  // not the throttle of +3 V
  EXPECT_EQ(throttle_from_motor_voltage(esc, 3.7, 4.0), 1.0);
  EXPECT_EQ(throttle_from_motor_voltage(esc, 0.0, 2.0), 1.0);
}

TEST(Esc, DeadZoneOfNegativeOffsetGivesNoVoltage) {
  Esc esc = kaylion().esc;
  esc.offset_v2 = -1.0;
  EXPECT_EQ(motor_voltage(esc, 3.7, 0.01), 0.0);
  EXPECT_NEAR(throttle_from_motor_voltage(esc, 3.7, 0.0), 1.0 / (0.9205 * 3.7 * 3.7), 1e-15);
}

TEST(Esc, SupplyCurrentConservesPowerAndNeverFlowsBack) {
  EXPECT_DOUBLE_EQ(esc_supply_current(4.0, 2.0, 0.5), 0.25);
  EXPECT_EQ(esc_supply_current(4.0, 2.0, -0.5), 0.0);
  EXPECT_EQ(esc_supply_current(0.0, 2.0, 0.5), 0.0);
}

TEST(Esc, FiniteArgumentsGiveFiniteResults) {
  const Esc& esc = kaylion().esc;
  const double values[] = {-1e100, -1.0, -1e-300, 0.0, 1e-300, 1.0, 1e100};
  for (const double a : values) {
    EXPECT_TRUE(std::isfinite(throttle_from_pulse_width(esc, a)));
    EXPECT_TRUE(std::isfinite(pulse_width_from_throttle(esc, a)));
    for (const double b : values) {
      EXPECT_TRUE(std::isfinite(motor_voltage(esc, a, b))) << a << " " << b;
      EXPECT_TRUE(std::isfinite(throttle_from_motor_voltage(esc, a, b))) << a << " " << b;
    }
  }
}

}  // namespace swiftlet::plant::esc_test

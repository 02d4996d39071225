#include "swiftlet/plant/model/battery.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::battery_test {

using tests::kaylion;
using tests::UniformRandom;

TEST(Battery, OpenCircuitVoltageMatchesTheTable) {
  const BatteryParameters& battery = kaylion().battery;
  for (std::size_t i = 0; i < battery.state_of_charge.size(); ++i) {
    EXPECT_NEAR(open_circuit_voltage(battery, battery.state_of_charge[i]), battery.open_circuit_voltage_v[i],
                1e-12);
  }
  EXPECT_DOUBLE_EQ(open_circuit_voltage(battery, 1.0), 4.19);
  EXPECT_DOUBLE_EQ(open_circuit_voltage(battery, 0.0), 2.65);
}

TEST(Battery, OpenCircuitVoltageIsLinearBetweenPoints) {
  BatteryParameters battery = kaylion().battery;
  battery.state_of_charge = {0.0, 0.25, 1.0};
  battery.open_circuit_voltage_v = {3.0, 3.5, 4.1};
  EXPECT_NEAR(open_circuit_voltage(battery, 0.125), 3.25, 1e-12);
  EXPECT_NEAR(open_circuit_voltage(battery, 0.5), 3.7, 1e-12);
}

TEST(Battery, ClampsToTheEndsOfTheTable) {
  const BatteryParameters& battery = kaylion().battery;
  EXPECT_DOUBLE_EQ(open_circuit_voltage(battery, -0.5), 2.65);
  EXPECT_DOUBLE_EQ(open_circuit_voltage(battery, 1.5), 4.19);
  EXPECT_DOUBLE_EQ(state_of_charge_from_voltage(battery, 2.0), 0.0);
  EXPECT_DOUBLE_EQ(state_of_charge_from_voltage(battery, 5.0), 1.0);
}

TEST(Battery, StateOfChargeInvertsVoltage) {
  UniformRandom draw;
  for (int i = 0; i < 1000; ++i) {
    const double soc = draw(0.0, 1.0);
    EXPECT_NEAR(state_of_charge_from_voltage(kaylion().battery, open_circuit_voltage(kaylion().battery, soc)),
                soc, 1e-12);
  }
}

TEST(Battery, DischargeRateIsCurrentOverCapacity) {
  // 240 mAh at 2.4 A last a tenth of an hour.
  EXPECT_NEAR(state_of_charge_rate(kaylion().battery, 2.4), -1.0 / 360.0, 1e-15);
}

TEST(Battery, SagSettlesAtResistanceTimesCurrent) {
  const BatteryParameters& battery = kaylion().battery;
  EXPECT_NEAR(sag_rate(battery, 2.0, 0.24), 0.0, 1e-12);
  // One time constant takes a step to 1 - 1/e: explicit Euler with tiny steps.
  double sag = 0.0;
  const int steps = 100000;
  for (int i = 0; i < steps; ++i) sag += sag_rate(battery, 2.0, sag) * battery.sag_time_constant_s / steps;
  EXPECT_NEAR(sag, 0.24 * (1.0 - std::exp(-1.0)), 1e-5);
}

TEST(Battery, TerminalVoltageIsNeverNegative) {
  EXPECT_DOUBLE_EQ(terminal_voltage(kaylion().battery, 1.0, 0.19), 4.0);
  EXPECT_EQ(terminal_voltage(kaylion().battery, 1.0, 99.0), 0.0);
}

}  // namespace swiftlet::plant::battery_test

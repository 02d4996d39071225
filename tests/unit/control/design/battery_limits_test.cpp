#include "swiftlet/control/design/battery_limits.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/endurance.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::control::battery_limits_test {

TEST(BatteryLimits, AreThoseOfTheBatteryWhereNoneAreSet) {
  plant::Vehicle vehicle = tests::kaylion();
  FailsafeSettings settings;
  settings.low_battery_voltage = 3.4;
  settings.critical_battery_voltage = 3.2;
  EXPECT_EQ(with_battery_limits(settings, vehicle).low_battery_voltage, 3.4);
  EXPECT_EQ(with_battery_limits(settings, vehicle).critical_battery_voltage, 3.2);

  settings.low_battery_voltage = settings.critical_battery_voltage = 0.0;
  const FailsafeSettings found = with_battery_limits(settings, vehicle);
  EXPECT_EQ(found.low_battery_voltage, plant::hover_voltage(vehicle, 0.05));
  EXPECT_EQ(found.critical_battery_voltage, plant::hover_voltage(vehicle, 0.03));
  EXPECT_LT(found.critical_battery_voltage, found.low_battery_voltage);

  settings.low_battery_voltage = 3.0;
  EXPECT_EQ(with_battery_limits(settings, vehicle).critical_battery_voltage, 3.0) << "not above the other";
}

// v_s = v_oc - R (i_e + P / v_s), Eq. (9), solved by hand of this vehicle: with 0.12 ohm, 0.08 A and twice the voltages of one cell.
TEST(BatteryLimits, OfTwoCellsAreTwiceAsHigh) {
  plant::Vehicle vehicle = tests::kaylion();
  FailsafeSettings settings;
  settings.low_battery_voltage = settings.critical_battery_voltage = 0.0;
  const double one_cell_v = with_battery_limits(settings, vehicle).low_battery_voltage;
  EXPECT_GT(one_cell_v, 3.2);
  EXPECT_LT(one_cell_v, 3.52) << "below the open circuit's at 5 %";
  for (double& voltage_v : vehicle.battery.open_circuit_voltage_v) voltage_v *= 2.0;
  vehicle.battery.internal_resistance_ohm *= 2.0;
  const double two_cells_v = with_battery_limits(settings, vehicle).low_battery_voltage;
  EXPECT_GT(two_cells_v, 2.0 * one_cell_v);
  EXPECT_LT(two_cells_v, 2.0 * 3.52);
}

}  // namespace swiftlet::control::battery_limits_test

#include "swiftlet/plant/model/endurance.hpp"

#include <gtest/gtest.h>

#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/plant/simulation/dynamics.hpp"
#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::plant::endurance_test {

using tests::kaylion;

// The vehicle hangs at the throttle of hover, which follows the voltage, until the voltage is at the threshold.
double simulated_s(const Vehicle& vehicle, double state_of_charge, double least_voltage_v) {
  constexpr double kStep_s = 0.005;
  const Dynamics dynamics(vehicle, Supply::battery());
  VehicleState state;
  state.state_of_charge = state_of_charge;
  state.rotor_speeds.fill(hover_speed(vehicle));
  MotorCommand drive;
  drive.state = RotorState::kRunning;
  double time_s = 0.0;
  // The sag takes some time constants to settle.
  while (time_s < 0.2 || dynamics.supply_voltage(state) >= least_voltage_v) {
    drive.throttle.fill(
        throttle_from_steady_thrust(vehicle, dynamics.supply_voltage(state), hover_thrust(vehicle)));
    dynamics.advance(state, drive, Eigen::Vector3d::Zero(), kStep_s);
    time_s += kStep_s;
  }
  return time_s;
}

TEST(Endurance, IsThatOfTheSimulation) {
  for (const double charge : {0.1, 0.3}) {
    const double told_s = hover_endurance_s(kaylion(), charge, 3.3);
    EXPECT_NEAR(told_s, simulated_s(kaylion(), charge, 3.3), 0.02 * told_s);
  }
}

TEST(Endurance, EndsWithTheVoltageOrTheCharge) {
  const double full_s = hover_endurance_s(kaylion(), 1.0, 3.3);
  EXPECT_GT(full_s, 300.0);
  EXPECT_LT(hover_endurance_s(kaylion(), 1.0, 3.6), full_s);
  EXPECT_LT(hover_endurance_s(kaylion(), 0.5, 3.3), 0.55 * full_s);
  EXPECT_EQ(hover_endurance_s(kaylion(), 0.5, 4.3), 0.0) << "below the threshold at once";
  EXPECT_GT(hover_endurance_s(kaylion(), 1.0, 0.0), full_s) << "until it is empty";
}

}  // namespace swiftlet::plant::endurance_test

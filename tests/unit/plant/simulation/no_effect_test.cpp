#include "swiftlet/plant/simulation/no_effect.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/plant/model/vehicles.hpp"

namespace swiftlet::tests::no_effect_test {

using plant::Fault;
using plant::FaultKind;
using plant::SimulationSettings;
using Sentences = std::vector<std::string>;

constexpr double kFlight_s = 40.0;

Fault fault(FaultKind kind, double at_s) {
  Fault fault;
  fault.kind = kind;
  fault.at_s = at_s;
  fault.for_s = 1.0;
  return fault;
}

plant::Vehicle vehicle_with_drag(double linear_drag) {
  plant::Vehicle vehicle = kaylion();
  vehicle.linear_drag = linear_drag;
  return vehicle;
}

TEST(SettingsWithoutEffect, AreNoneByDefault) {
  EXPECT_EQ(settings_without_effect({}, vehicle_with_drag(0.0), kFlight_s), Sentences{});
}

TEST(SettingsWithoutEffect, AreWindAndGustsWithoutDrag) {
  SimulationSettings settings;
  settings.air.wind_ned.x() = 4.0;
  settings.air.gust_sigma_ned.y() = 1.0;
  settings.faults = {fault(FaultKind::kWind, 5.0)};
  const std::string why = " has no effect: linear_drag of kaylion and air.rotor_drag are 0";
  EXPECT_EQ(settings_without_effect(settings, vehicle_with_drag(0.0), kFlight_s),
            (Sentences{"air.wind_ned_m_s" + why, "air.gust_sigma_ned_m_s" + why, "faults[0], wind" + why}));
  EXPECT_EQ(settings_without_effect(settings, vehicle_with_drag(0.01), kFlight_s), Sentences{});
  settings.air.drag = false;
  EXPECT_EQ(settings_without_effect(settings, vehicle_with_drag(0.01), kFlight_s).size(), 3U);
  settings.air.rotor_drag = 1e-6;
  EXPECT_EQ(settings_without_effect(settings, vehicle_with_drag(0.0), kFlight_s), Sentences{});
}

TEST(SettingsWithoutEffect, AreFaultsAfterTheFlightAndOfWhatTheVehicleDoesNotHave) {
  SimulationSettings settings;
  settings.rotor_speed_rate_hz = 0.0;
  settings.faults = {fault(FaultKind::kPush, 39.9), fault(FaultKind::kPush, 500.0),
                     fault(FaultKind::kRotorSpeedsStop, 5.0), fault(FaultKind::kOdometryJump, 5.0)};
  EXPECT_EQ(settings_without_effect(settings, vehicle_with_drag(0.0), kFlight_s),
            (Sentences{"faults[1], push has no effect: it begins at 500 s, the flight ended at 40 s",
                       "faults[2], rotor_speeds_stop has no effect: rotor_speed_rate_hz is 0",
                       "faults[3], odometry_jump has no effect: the vehicle has no estimate of its own"}));
}

}  // namespace swiftlet::tests::no_effect_test

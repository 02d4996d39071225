#include "swiftlet/control/design/battery_limits.hpp"

#include <algorithm>

#include "swiftlet/plant/model/endurance.hpp"

namespace swiftlet::control {
namespace {

constexpr double kLowCharge = 0.05;
constexpr double kCriticalCharge = 0.03;

}  // namespace

FailsafeSettings with_battery_limits(FailsafeSettings settings, const plant::Vehicle& vehicle) {
  if (settings.low_battery_voltage == 0.0)
    settings.low_battery_voltage = plant::hover_voltage(vehicle, kLowCharge);
  if (settings.critical_battery_voltage == 0.0)
    settings.critical_battery_voltage =
        std::min(plant::hover_voltage(vehicle, kCriticalCharge), settings.low_battery_voltage);
  return settings;
}

}  // namespace swiftlet::control

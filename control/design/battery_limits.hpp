// The voltages below which a vehicle lands.
#pragma once

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// The settings with low_battery_voltage and critical_battery_voltage in place of 0: what the vehicle's battery gives in hover,
// plant::hover_voltage(), with 5 % and 3 % of its charge left. 0 still if it cannot carry the vehicle then.
FailsafeSettings with_battery_limits(FailsafeSettings settings, const plant::Vehicle& vehicle);

}  // namespace swiftlet::control

// The gains of a design as the control laws use them, and the check of a change of gains in flight.
#pragma once

#include <optional>

#include "swiftlet/control/design/control_design.hpp"
#include "swiftlet/control/types/gains.hpp"

namespace swiftlet::control {

ControlGains control_gains(const ControlDesign& design, const ControlSettings& settings);

// Least delay that each loop must tolerate at every point of a change in flight, s: five IMU samples at 500
// Hz, for sampling, transport and computation.
constexpr double kLeastDelayMargin_s = 0.010;

// Checks that all six loops are stable on the way from one set of gains to the other, with the rotor lag and
// a delay of kLeastDelayMargin_s: gains between two stable sets need not be stable. Returns the first loop
// that is not, with the key as in the control settings file. Allocates memory.
std::optional<plant::Violation> unstable_change(const ControlGains& from, const ControlGains& to,
                                                double rotor_lag_s);

}  // namespace swiftlet::control

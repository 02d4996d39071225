// The delay that the loops of a design tolerate in flight.
#pragma once

#include <array>
#include <functional>

#include "swiftlet/control/design/flown_loops.hpp"

namespace swiftlet::control {

// Longest delay that is examined, s.
constexpr double kLongestDelay_s = 0.5;

// Least delay from a sample to the rotors, s, at which each loop of flown_loops() is unstable, to 0.01 ms; infinite if that
// is none up to kLongestDelay_s, 0 for a loop that is unstable without delay. In the order of kFlownLoopNames. Sampling
// takes half a period of the IMU of it, because a command holds until the next one.
std::array<double, 6> flown_delay_margins(const ControlDesign& design, const ControlSettings& settings);
// The same of any loops at a delay, s.
using LoopsAtDelay = std::function<std::array<FlownLoop, 6>(double delay_s)>;
std::array<double, 6> delay_margins(const LoopsAtDelay& loops);

// The least of them, rounded down to kLeastDelayAccuracy_s; kLongestDelay_s if it is longer.
constexpr double kLeastDelayAccuracy_s = 1e-3;
double least_flown_delay_margin(const ControlGains& gains, const ObservedRotors& rotors);
double least_delay_margin(const LoopsAtDelay& loops);

}  // namespace swiftlet::control

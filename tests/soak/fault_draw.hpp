// Which faults a flight of the soak meets: drawn from the seed, of all kinds, from milliseconds to seconds.
#pragma once

#include <cstdint>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"

namespace swiftlet::soak {

// One every four seconds on average, from first_s to last_s, in the order of their beginnings. What some of
// them may do is bounded by what can be flown with: a rotor keeps three quarters of its thrust, a command
// comes at most 20 ms late, a push gives at most 0.5 m/s.
std::vector<plant::Fault> draw_faults(std::uint64_t seed, double first_s, double last_s,
                                      const plant::Vehicle& vehicle, const control::Limits& limits);

}  // namespace swiftlet::soak

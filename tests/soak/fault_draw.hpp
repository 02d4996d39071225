// Random faults of a soak flight, sampled from its seed: all kinds, from milliseconds to seconds.
#pragma once

#include <cstdint>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"

namespace swiftlet::soak {

// Samples one fault every 4 s on average, from first_s to last_s, in order of start. Severity is bounded so
// that the vehicle remains flyable: a rotor keeps at least 85 % of its thrust, a command is at most 20 ms
// late, a push adds at most 0.5 m/s.
std::vector<plant::Fault> draw_faults(std::uint64_t seed, double first_s, double last_s,
                                      const plant::Vehicle& vehicle, const control::Limits& limits);

}  // namespace swiftlet::soak

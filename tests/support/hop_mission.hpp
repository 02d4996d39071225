// A short mission: take-off, one waypoint, landing.
#pragma once

#include <string>

namespace swiftlet::tests {

inline const std::string kHopMission =
    "name: hop\n"
    "frame: ned\n"
    "tolerance_m: 0.1\n"
    "items:\n"
    "  - {kind: takeoff, height_m: 0.5, speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [0.5, -0.3, -0.7], speed_m_s: 0.5}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";

}  // namespace swiftlet::tests

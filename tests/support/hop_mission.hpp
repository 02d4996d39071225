// Short missions.
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

// Like config/missions/square.yaml, with sides of 1 m: 16 s at its height.
inline const std::string kSmallSquareMission =
    "name: small square\n"
    "frame: ned\n"
    "tolerance_m: 0.1\n"
    "items:\n"
    "  - {kind: takeoff, height_m: 1.0, speed_m_s: 0.5, hold_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [1, 1, -1], speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [0, 1, -1], speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [0, 0, -1], speed_m_s: 0.5, hold_s: 0.5}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";

}  // namespace swiftlet::tests

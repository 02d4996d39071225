// Plausibility limits, far outside the range of micro and small multirotors. A reading beyond them has the
// wrong unit.
#pragma once

namespace swiftlet::identification {

constexpr double kLeastSupplyVoltage = 0.5;     // V
constexpr double kMostSupplyVoltage = 1000.0;   // V
constexpr double kLeastMotorVoltage = 0.05;     // V
constexpr double kMostMotorVoltage = 1000.0;    // V
constexpr double kLeastRotorSpeed = 20.0;       // rad/s
constexpr double kMostRotorSpeed = 2e4;         // rad/s, 190,000 rpm
constexpr double kSpeedOfSound = 340.0;         // m/s, limit of the blade tip speed
constexpr double kLeastTorquePerThrust = 2e-4;  // m; typical is 0.1 of the rotor radius, which is above 5 mm
constexpr double kMostTorquePerThrust = 0.15;   // m; for a rotor of 1 m
constexpr double kLeastGyration = 0.15;         // radius of gyration over the hubs' distance from the centre
constexpr double kMostGyration = 1.2;
constexpr double kMostOfSupply = 1.5;        // fitted ESC voltage at full throttle over the supply voltage
constexpr double kLeastTimeConstant = 1e-3;  // s, of a motor with its rotor
constexpr double kMostTimeConstant = 3.0;    // s

}  // namespace swiftlet::identification

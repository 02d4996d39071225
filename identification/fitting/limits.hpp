// Limits that no micro or small multirotor comes near: beyond them a reading has the wrong unit.
#pragma once

namespace swiftlet::identification {

constexpr double kLeastSupplyVoltage = 0.5;     // V
constexpr double kMostSupplyVoltage = 1000.0;   // V
constexpr double kLeastMotorVoltage = 0.05;     // V
constexpr double kMostMotorVoltage = 1000.0;    // V
constexpr double kLeastRotorSpeed = 20.0;       // rad/s
constexpr double kMostRotorSpeed = 2e4;         // rad/s, 190,000 rpm
constexpr double kSpeedOfSound = 340.0;         // m/s, that blade tips stay below
constexpr double kLeastTorquePerThrust = 2e-4;  // m; about a tenth of a rotor's radius, which is above 5 mm
constexpr double kMostTorquePerThrust = 0.15;   // m, of a rotor of a metre
constexpr double kLeastGyration = 0.15;         // radius of gyration over the hubs' distance from the centre
constexpr double kMostGyration = 1.2;
constexpr double kMostOfSupply = 1.5;        // of an ESC's voltage at full throttle, by its fit
constexpr double kLeastTimeConstant = 1e-3;  // s, of a motor with its rotor
constexpr double kMostTimeConstant = 3.0;    // s

}  // namespace swiftlet::identification

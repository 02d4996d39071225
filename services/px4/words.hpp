// PX4's states, commands and results in words.
#pragma once

#include <cstdint>
#include <string>

#include "swiftlet/services/px4/px4_topics.hpp"

namespace swiftlet::px4 {

constexpr std::uint8_t kAutopilotComponent = 1;  // of MAVLink: the flight controller

// VehicleStatus:
constexpr std::uint8_t kArmingStateArmed = 2;
constexpr std::uint8_t kNavStateOffboard = 14;
constexpr std::uint8_t kNavStateLand = 18;
constexpr std::uint8_t kNavStateDescend = 12;
constexpr std::uint8_t kNavStateTermination = 13;

// VehicleCommand and VehicleCommandAck:
constexpr std::uint32_t kCommandLand = 21;
constexpr std::uint32_t kCommandSetMode = 176;
constexpr std::uint32_t kCommandArmDisarm = 400;
constexpr std::uint8_t kResultAccepted = 0;
constexpr std::uint8_t kResultTemporarilyRejected = 1;
constexpr std::uint8_t kResultDenied = 2;
constexpr std::uint8_t kResultUnsupported = 3;
constexpr std::uint8_t kResultInProgress = 5;

std::string mode_name(std::uint8_t nav_state);      // "Land"
std::string disarming_reason(std::uint8_t reason);  // "kill switch"
std::string result_text(std::uint8_t result);       // "temporarily rejected"
// What fails of PX4's checks for offboard: "local position invalid, battery warning 2"; "" if nothing does.
std::string failing_checks(const msg::FailsafeFlags& flags);

}  // namespace swiftlet::px4

// Ids of the random streams. An id never changes once assigned, so that runs of a seed repeat across
// releases.
#pragma once

#include <cstdint>
#include <string_view>

namespace swiftlet::plant::streams {

constexpr std::uint64_t kGusts = 1;
constexpr std::uint64_t kAccelerometerNoise = 2;
constexpr std::uint64_t kGyroNoise = 3;
constexpr std::uint64_t kAccelerometerBias = 4;
constexpr std::uint64_t kGyroBias = 5;
constexpr std::uint64_t kMocapPosition = 6;
constexpr std::uint64_t kMocapOrientation = 7;
constexpr std::uint64_t kMocapMisalignment = 8;
constexpr std::uint64_t kMocapDropouts = 9;
constexpr std::uint64_t kMocapIntervals = 10;
constexpr std::uint64_t kMocapOtherBody = 20;
constexpr std::uint64_t kBarometer = 30;
constexpr std::uint64_t kMagnetometer = 31;
constexpr std::uint64_t kGpsNoise = 32;
constexpr std::uint64_t kGpsDrift = 33;
constexpr std::uint64_t kOdometry = 34;
constexpr std::uint64_t kRadioTelemetry = 40;
constexpr std::uint64_t kRadioCommands = 41;
constexpr std::uint64_t kRadioPoses = 42;

// Stream id of a parameter that is drawn once per run: the FNV-1a hash of its name.
constexpr std::uint64_t of_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace swiftlet::plant::streams

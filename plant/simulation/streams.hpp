// Which random stream is whose. A number, once given, stays: runs of one seed repeat from release to release.
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

// The stream of a parameter that is drawn once a run, by its name: FNV-1a.
constexpr std::uint64_t of_name(std::string_view name) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : name) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace swiftlet::plant::streams

// Which random stream is whose. A number, once given, stays: runs of one seed repeat from release to release.
#pragma once

#include <cstdint>

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

}  // namespace swiftlet::plant::streams

// Decimation of telemetry.
#pragma once

#include <algorithm>
#include <cstdint>

namespace swiftlet::runtime {

// True for 100 samples per second. The sequence number decides, so that all publishers select the same
// stamps.
inline bool is_telemetry_sample(std::uint64_t imu_sequence, std::int64_t imu_period_ns) {
  constexpr std::int64_t kPeriodNs = 10'000'000;
  const std::int64_t every =
      imu_period_ns > 0 ? std::max<std::int64_t>((kPeriodNs + imu_period_ns / 2) / imu_period_ns, 1) : 1;
  return imu_sequence % static_cast<std::uint64_t>(every) == 0;
}

}  // namespace swiftlet::runtime

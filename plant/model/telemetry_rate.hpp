// Decimation of telemetry.
#pragma once

#include <algorithm>
#include <cstdint>

namespace swiftlet::plant {

// True for 100 samples per second. The sequence number decides, so that all publishers select the same
// stamps.
inline std::uint64_t telemetry_interval(std::int64_t imu_period_ns) {
  constexpr std::int64_t kPeriodNs = 10'000'000;
  return imu_period_ns > 0 ? static_cast<std::uint64_t>(
                                 std::max<std::int64_t>((kPeriodNs + imu_period_ns / 2) / imu_period_ns, 1))
                           : 1;
}
inline bool is_telemetry_sample(std::uint64_t imu_sequence, std::int64_t imu_period_ns) {
  return imu_sequence % telemetry_interval(imu_period_ns) == 0;
}

// The same for a receiver that misses samples: also true for the first sample after a missed one. last_sequence: of the
// sample received before.
inline bool is_telemetry_sample(std::uint64_t imu_sequence, std::uint64_t last_sequence,
                                std::int64_t imu_period_ns) {
  const std::uint64_t every = telemetry_interval(imu_period_ns);
  return is_telemetry_sample(imu_sequence, imu_period_ns) || imu_sequence / every > last_sequence / every;
}

}  // namespace swiftlet::plant

// When a flight does what, in simulated time, so that a flight in lockstep over DDS and one in this process
// are the same.
#pragma once

#include <cstdint>

namespace swiftlet::ground {

// Requests are made between an answered IMU sample and the next; in lockstep, while time stands still.
struct FlightSchedule {
  static constexpr std::int64_t kFirstRequestNs = 1'000'000'000;  // the estimator has settled
  static constexpr std::int64_t kRetryNs = 200'000'000;           // after a refusal to arm
  static constexpr std::int64_t kLastArmingNs = 6'000'000'000;

  // From the start of the mission.
  static double time_limit_s(double planned_duration_s) { return 1.5 * planned_duration_s + 30.0; }
};

}  // namespace swiftlet::ground

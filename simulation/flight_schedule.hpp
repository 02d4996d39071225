// Times of the requests of a simulated flight, so that a flight in lockstep over DDS and one in a single
// process are identical.
#pragma once

#include <cstdint>

namespace swiftlet::ground {

// Simulated time, ns. Requests are made after the command for one IMU sample and before the next IMU sample;
// in lockstep the simulation clock is stopped meanwhile.
struct FlightSchedule {
  static constexpr std::int64_t kFirstRequestNs = 1'000'000'000;  // the estimator has converged by then
  static constexpr std::int64_t kRetryNs = 200'000'000;           // interval between requests to arm
  static constexpr std::int64_t kLastArmingNs = 6'000'000'000;    // time of the last request to arm

  // Time limit of a mission, s, from its start.
  static double time_limit_s(double planned_duration_s) { return 1.5 * planned_duration_s + 30.0; }
};

}  // namespace swiftlet::ground

// When the poses of a log were taken by the clock of its IMU.
//
// A pose turns between two stamps as the gyro says between two times, each a delay before the stamp:
//   q(t)* q(t + s) = exp of the gyro's rate, less its offset, from t - T to t + s - T.
// First by the lag at which the rates of both go together best, then as an output error: integrated over each
// stretch from a start that is free.
#pragma once

#include <array>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/recording/flight_log.hpp"

namespace swiftlet::identification {

struct PoseTiming {
  bool identified = false;                       // there were poses enough, and the vehicle turned enough
  ParameterEstimate delay;                       // T, s: positive where poses are stamped late
  std::array<ParameterEstimate, 3> gyro_offset;  // rad/s
};

// By stretches of one flight. Throws BadData where poses turn otherwise than the gyro, whatever the delay: by
// another unit, or frame, or clock.
PoseTiming find_pose_timing(const FlightLog& log, const std::vector<Rows>& segments);

}  // namespace swiftlet::identification

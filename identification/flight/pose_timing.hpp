// Identifies the delay of a log's pose time stamps relative to the clock of its IMU.
//
// The rotation between the stamps of two poses equals the gyro's rotation, both times a delay T earlier:
//   q(t)* q(t + s) = exp of the integral of the gyro's rate, less its offset, from t - T to t + s - T.
// A first search takes the lag with the highest correlation of the two rates. A fit refines it by an output
// error: the gyro is integrated over each segment from a free initial attitude.
#pragma once

#include <array>
#include <vector>

#include "swiftlet/identification/fitting/estimate.hpp"
#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight_log.hpp"

namespace swiftlet::identification {

struct PoseTiming {
  bool identified = false;                       // enough poses, and enough rotation
  ParameterEstimate delay;                       // T, s: positive if poses are stamped late
  std::array<ParameterEstimate, 3> gyro_offset;  // rad/s
};

// Fits over segments of one flight. Throws BadData if poses and gyro do not show the same rotation at any
// delay: unit, frame or clock of one of them is wrong.
PoseTiming find_pose_timing(const FlightLog& log, const std::vector<Rows>& segments);

}  // namespace swiftlet::identification

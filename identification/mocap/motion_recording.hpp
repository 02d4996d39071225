// What a fit of a body to the motion of its vehicle uses of a log.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "swiftlet/identification/flight_log.hpp"

namespace swiftlet::identification {

constexpr double kShortestPoseInterval_s = 0.009;  // between poses that are used

// The poses of a body in flight, and the samples of the IMU between them.
struct MotionRecording {
  struct Reading {
    double dt = 0.0;        // s
    Eigen::Vector3d force;  // m/s^2, FRD
    Eigen::Vector3d rates;  // rad/s, FRD
  };
  // Between two poses.
  struct Interval {
    double duration_s = 0.0;
    bool is_gap = false;
    std::vector<Reading> readings;
  };

  std::vector<FlightPose> poses;
  std::vector<Interval> intervals;     // one less than poses
  std::vector<Eigen::Vector3d> force;  // at the poses
  std::vector<Eigen::Vector3d> rates;

  // RMS of the rates about their mean, rad/s.
  double rms_rates() const;
};

// The recording of a log, which has at least two samples of the IMU. If the log has a take-off or a landing, only the poses
// in the air count.
MotionRecording recording_of(const FlightLog& log);

// Density of white noise, in units of the values per square root of Hz, from second differences: the motion has next to none.
// Their median leaves out impacts.
double noise_density(const std::vector<double>& time_s, const std::vector<Eigen::Vector3d>& values,
                     double least);

}  // namespace swiftlet::identification

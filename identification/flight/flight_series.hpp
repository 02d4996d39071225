// Prepares a log for the fit: steady rotor speeds of its commands, motion from its poses, segments of time.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight/pose_timing.hpp"
#include "swiftlet/identification/flight_log.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::identification {

// Where rotor speeds come from.
enum class SpeedSource {
  kMeasured,   // recorded in the log
  kModelled,   // from command and supply voltage by Eq. (9), (22) and (18) with the base vehicle's parameters
  kCommanded,  // poses or supply voltage were not recorded: only commands and IMU are used
};

// Length of a segment of a residual channel. The residuals inside a segment may be correlated.
constexpr double kSegmentS = 0.5;

constexpr double kLongestRowGapS = 0.05;  // s, longest allowed gap between samples of a flight

struct FlightSeries {
  const FlightLog* log = nullptr;
  FlightWindow window;
  Rows estimation_set;  // first four fifths of the flight, for the fit
  Rows validation_set;  // last fifth, for the prediction errors
  SpeedSource source = SpeedSource::kMeasured;
  // The rest is empty for kCommanded.
  std::vector<plant::PerRotor> steady_speeds;  // rad/s, steady speeds of each row's commands
  PoseTiming pose_timing;                      // its delay is removed from velocity_ned and attitude
  std::vector<Eigen::Vector3d> velocity_ned;   // m/s, of each row, from the poses
  std::vector<Eigen::Quaterniond> attitude;    // q_ned_from_frd of each row, from the poses
  std::vector<Rows> segments;                  // of the estimation set
};

// Chooses the best SpeedSource that the logs support; it must be the same for all. The logs must outlive the
// result. Throws BadData.
std::vector<FlightSeries> prepare_flights(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                          const FlightBounds& bounds);

// Rotor speeds at the times of `rows`, rad/s: the steady speeds, each held from its row on, delayed by
// delay_s and filtered by the first-order rotor lag, Eq. (18), reduced model. The filter starts at the steady
// speeds of the first row of the log.
std::vector<plant::PerRotor> lagged_speeds(const FlightLog& log, const std::vector<plant::PerRotor>& steady,
                                           const Rows& rows, double time_constant_s, double delay_s);

}  // namespace swiftlet::identification

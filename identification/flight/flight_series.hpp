// A log made ready for fits: steady speeds that its commands ask of the rotors, motion by its poses,
// stretches of time.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "swiftlet/identification/flight/flight_window.hpp"
#include "swiftlet/identification/flight/pose_timing.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/recording/flight_log.hpp"

namespace swiftlet::identification {

// Where the rotors' speeds are from.
enum class SpeedSource {
  kMeasured,   // by the vehicle
  kModelled,   // from command and supply voltage by Eq. (9), (22) and (18) with the base vehicle's numbers
  kCommanded,  // neither: poses or supply voltage were not recorded, and the command is all there is
};

// What a channel of residuals is cut into; inside, samples hang together.
constexpr double kStretchS = 0.5;

constexpr double kLongestRowGapS = 0.05;  // between samples of a flight

struct FlightSeries {
  const FlightLog* log = nullptr;
  FlightWindow window;
  Rows estimation_set;  // the first four fifths of the flight
  Rows validation_set;  // the last one, for predictions
  SpeedSource source = SpeedSource::kMeasured;
  // None of the following of kCommanded.
  std::vector<plant::PerRotor> steady_speeds;  // that the commands ask for, from each row on, rad/s
  PoseTiming pose_timing;                      // motion and attitude are of poses with its delay taken off
  std::vector<Eigen::Vector3d> velocity_ned;   // of each row, by the poses
  std::vector<Eigen::Quaterniond> attitude;    // NED from FRD, likewise
  std::vector<Rows> segments;                  // of fitted
};

// Chooses the best source of speeds that the logs have, which must be the same of all. They must outlive what
// is returned. Throws BadData.
std::vector<FlightSeries> prepare_flights(const std::vector<FlightLog>& logs, const plant::Vehicle& base,
                                          const FlightBounds& bounds);

// Steady speeds, each from its row on, behind the rotors' lag, Eq. (18) in its reduced form, a delay later:
// at the times of `rows`. The lag is started with the log, at the speeds
// that are steady there.
std::vector<plant::PerRotor> lagged_speeds(const FlightLog& log, const std::vector<plant::PerRotor>& steady,
                                           const Rows& rows, double time_constant_s, double delay_s);

}  // namespace swiftlet::identification

// What a flight came to: for the eye and for scripts.
#pragma once

#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "swiftlet/recording/tracking.hpp"

namespace swiftlet::ground {

// Sense-to-actuate: IMU sample written by the vehicle to command received by it.
struct LatencyFigures {
  double p50_us = 0.0;
  double p99_us = 0.0;
  double max_us = 0.0;
};

struct FlightReport {
  bool completed = false;
  std::string reason;  // why not; empty if completed

  std::string clock;  // "realtime", "lockstep" or "in process"
  std::string mission;
  std::string vehicle_name;                             // "kl1"; empty: in process
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();  // m, where it stood; the mission lies as far off
  std::string vehicle;                                  // names or files, as flown
  std::string control;
  std::string dispersion;  // empty: what flew is as the files say
  std::uint64_t seed = 0;
  std::string record_dir;

  double duration_s = 0.0;   // from the mission's start to rotors off, or to what ended it
  double tolerance_m = 0.0;  // on the peak 3-D error
  TrackingErrors errors;     // from the mission's start to the landing command
  double imu_rate_hz = 0.0;
  double simulated_s = 0.0;  // from stamp 0
  double wall_s = 0.0;       // that this took

  // Of a flight in real time.
  double control_rate_hz = 0.0;
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t unanswered = 0;  // IMU samples that no command answered
  double step_time_max_us = 0.0;
  bool realtime_scheduling = false;
  LatencyFigures sense_to_actuate;
};

// Lengths in m, times as the key says; what was not measured is null.
nlohmann::ordered_json to_json(const FlightReport& report);

// Several lines for a terminal, errors in mm.
std::string to_text(const FlightReport& report);

}  // namespace swiftlet::ground

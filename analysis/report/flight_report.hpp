// The result of a flight, as text and as JSON.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>

#include "swiftlet/record/evaluation.hpp"

namespace swiftlet::analysis {

// Sense-to-actuate latency: from the vehicle's write of an IMU sample to its receipt of the command.
struct LatencyFigures {
  double p50_us = 0.0;
  double p99_us = 0.0;
  double max_us = 0.0;
};

struct FlightReport {
  bool completed = false;
  std::string reason;  // why the flight failed; empty if completed

  std::string clock;  // "realtime", "lockstep" or "in process"
  std::string mission;
  std::string vehicle_name;                             // "kl1"; empty for an in-process flight
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();  // m, start position; the mission is shifted by it
  std::string vehicle;                                  // vehicle, control: names or files
  std::string control;
  std::string dispersion;  // empty: nominal vehicle and simulation
  std::uint64_t seed = 0;
  std::string record_dir;
  std::string record_fault;           // why the record is incomplete; empty if it is complete
  std::vector<std::string> warnings;  // a sentence each: what the settings asked for and cannot have happened

  double duration_s = 0.0;        // from mission start to rotors off, or to the failure
  double tolerance_m = 0.0;       // limit of the peak 3-D error
  record::TrackingErrors errors;  // from mission start to the landing command
  double imu_rate_hz = 0.0;
  double simulated_s = 0.0;  // of the vehicle's clock: in real time from when it was ready, else from stamp 0
  double wall_s = 0.0;       // elapsed real time

  // Only for a flight in real time.
  double control_rate_hz = 0.0;
  std::uint64_t cycles = 0;
  std::uint64_t deadline_misses = 0;
  std::uint64_t unanswered = 0;  // IMU samples without a command
  double step_time_max_us = 0.0;
  bool realtime_scheduling = false;
  LatencyFigures sense_to_actuate;
};

// Lengths in m, times in the unit of the key; a value that is not finite is null.
nlohmann::ordered_json to_json(const FlightReport& report);

// Several lines for a terminal, errors in mm.
std::string to_text(const FlightReport& report);

}  // namespace swiftlet::analysis

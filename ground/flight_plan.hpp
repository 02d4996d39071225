// All that a flight needs, found and checked before anything is started.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "control/settings.hpp"
#include "ground/child_process.hpp"
#include "ground/mission_file.hpp"
#include "services/comms/node.hpp"

namespace swiftlet::ground {

struct FlyOptions {
  std::string mission = "square";
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::string simulation = "default";
  std::string record;  // empty: flights/<date-time>-<mission>
  std::uint64_t seed = 1;
  int imu_rate_hz = 0;  // 0: as the simulation file says
  comms::NodeSettings network;
  int domain = -1;      // below 0: a free one, or 0 to attach
  bool attach = false;  // to plant, mocap and control that run already
  bool json = false;
};

struct FlightPlan {
  MissionFile mission;
  double planned_duration_s = 0.0;
  std::filesystem::path vehicle_file, control_file, simulation_file;
  std::string vehicle_name, control_name;
  int imu_rate_option_hz = 0;  // as FlyOptions
  double imu_rate_hz = 0.0;
  std::uint64_t seed = 0;
  std::filesystem::path folder;  // where the flight is recorded; not made yet
  bool attach = false;
  std::filesystem::path plant_program, mocap_program, control_program;  // none to attach
};

// Longer missions are refused: the record is kept in memory.
constexpr double kLongestMissionS = 600.0;

// Throws runtime::ConfigError or InputError for input that cannot be flown. Starts and writes nothing.
FlightPlan plan_flight(const FlyOptions& options);

// The three processes of the plan, on this network; none to attach.
std::vector<ProcessSettings> processes(const FlightPlan& plan, const comms::NodeSettings& network);

}  // namespace swiftlet::ground

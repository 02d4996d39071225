// All that a flight needs, found and checked before anything is started.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/report/flight_report.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/child_process.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::ground {

// Where plant, mocap and control run.
enum class LaunchMode {
  kStarted,    // in processes that this one starts
  kAttached,   // in processes that run already
  kInProcess,  // here, without DDS
};

struct FlyOptions {
  LaunchMode launch_mode = LaunchMode::kStarted;
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 1.0;  // of simulated time against real time
  std::string mission = "square";
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::string simulation = "default";
  std::string dispersion;  // of kInProcess: a dispersion file; empty: what flies is as the files say
  std::string record;      // empty: flights/<date-time>-<mission>
  std::uint64_t seed = 1;
  int imu_rate_hz = 0;  // 0: as the simulation file says
  comms::NodeSettings network;
  Eigen::Vector2d start_ned =
      Eigen::Vector2d::Zero();  // m, where the vehicle stands; the mission lies as far off
  double spacing_m = 1.0;       // of several vehicles, from one to the next, to the east
  int domain = -1;              // below 0: a free one, or 0 to attach
  bool trace = false;           // keep a trace of a lockstep or in-process flight
  bool sensors = false;         // keep what was sensed and commanded, for `swiftlet identify flight`
  bool json = false;
};

struct LaunchConfiguration {
  LaunchMode launch_mode = LaunchMode::kStarted;
  runtime::Clock clock = runtime::Clock::kRealtime;
  double speed = 1.0;
  MissionFile mission;
  double planned_duration_s = 0.0;
  std::filesystem::path vehicle_file, control_file, simulation_file, mission_file;
  plant::Vehicle vehicle;
  control::ControlSettings control;
  plant::SimulationSettings simulation;
  Dispersion dispersion;       // of what is flown; without variates unless asked for
  int imu_rate_option_hz = 0;  // as FlyOptions
  std::uint64_t seed = 0;
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();                  // m
  std::filesystem::path folder;                                         // of the record; not made yet
  std::filesystem::path trace_file;                                     // empty: none is kept
  bool sensors = false;                                                 // keep them
  std::filesystem::path plant_program, mocap_program, control_program;  // of kStarted

  std::size_t record_capacity() const;  // for each IMU sample of the longest that it may take
};

// Longer missions are refused: the record is kept in memory.
constexpr double kLongestMissionS = 600.0;

// Throws runtime::ConfigError or InputError for input that cannot be flown. Starts and writes nothing.
LaunchConfiguration plan_flight(const FlyOptions& options);

// What flies with a seed, while the controller is designed on plan.vehicle. Throws as draw() does.
DispersionSample draw(const LaunchConfiguration& plan, std::uint64_t seed);

// The three processes of a plan of kStarted, on this network; none of others.
std::vector<ProcessSettings> processes(const LaunchConfiguration& plan, const comms::NodeSettings& network);

// A report that says what is to be flown.
FlightReport report_of(const LaunchConfiguration& plan);

}  // namespace swiftlet::ground

// The complete, checked configuration of a flight, made before any process is started.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/analysis/report/flight_report.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/ground/flight/record_folder.hpp"
#include "swiftlet/ground/mission/pace.hpp"
#include "swiftlet/io/command_line/child_process.hpp"
#include "swiftlet/io/missions/mission_file.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "swiftlet/services/runtime/clock.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::ground {

// Where plant, mocap and control run.
enum class LaunchMode {
  kStarted,    // in processes that this one starts
  kAttached,   // in processes that are running already
  kInProcess,  // in this process, without DDS
};

struct FlyOptions {
  LaunchMode launch_mode = LaunchMode::kStarted;
  runtime::Clock clock = runtime::Clock::kRealtime;
  // Simulated time per real time. Unset: real time, or in lockstep as fast as possible.
  std::optional<double> speed;
  std::string mission = "square";
  ReadingOptions reading;
  std::string vehicle = "kaylion";
  std::string control = "motor_lag";
  std::string simulation = "default";
  std::string dispersion;  // kInProcess: a dispersion file; empty: no dispersion
  std::string record;      // empty: flights/<date-time>-<mission>
  bool replace = false;    // delete the record that is in the folder `record`
  std::uint64_t seed = 1;
  int imu_rate_hz = 0;                                              // 0: as in the simulation file
  plant::ControlLevel level = plant::ControlLevel::kActuators;      // at which the vehicle is commanded
  plant::OdometrySource odometry = plant::OdometrySource::kNone;    // brought by the simulated vehicle
  std::optional<double> radio_delay_s, radio_jitter_s, radio_loss;  // unset: as in the simulation file
  dds::NodeSettings network;
  // m, initial position, by which the mission is shifted
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();
  bool mission_at_start = true;  // false: the mission is not shifted
  int vehicles = 1;              // above 1: kl1, kl2 ... instead of network.vehicle
  double spacing_m = 1.0;        // distance between several vehicles, to the east
  int per_row = 0;               // several vehicles: further rows stand to the north; 0: all in one row
  // kStarted: swiftlet-px4 in place of plant, for this instance of PX4, which runs already; of several vehicles each
  // has the next one.
  std::optional<int> px4_instance;
  int domain = -1;                   // DDS domain; < 0: a free one, or 0 if attached or with px4_instance
  bool trace = false;                // write a trace of a lockstep or in-process flight
  bool view = false;                 // serve the live page beside the flight
  std::string program = "swiftlet";  // with its version, for the record
  bool skip_check = false;           // kAttached: do not check the vehicle before it is armed
  bool skip_hover_test = false;      // kAttached: do not let it hover before its first flight
  bool json = false;
};

struct LaunchConfiguration {
  LaunchMode launch_mode = LaunchMode::kStarted;
  runtime::Clock clock = runtime::Clock::kRealtime;
  std::optional<double> speed;
  io::MissionFile mission;
  double planned_duration_s = 0.0;  // by the dry run
  std::filesystem::path vehicle_file, control_file, simulation_file, mission_file;
  std::filesystem::path dispersion_file;  // empty without one
  plant::Vehicle vehicle;
  control::ControlSettings control;
  plant::SimulationSettings simulation;
  simulation::Dispersion dispersion;  // of vehicle and simulation; empty unless requested
  int imu_rate_option_hz = 0;         // FlyOptions::imu_rate_hz
  std::uint64_t seed = 0;
  Eigen::Vector2d start_ned = Eigen::Vector2d::Zero();  // m
  std::filesystem::path folder;                         // of the record; not created by plan_flight()
  bool trace = false;                                   // write trace_file()
  std::optional<int> px4_instance;                      // of FlyOptions
  std::filesystem::path vehicle_program, mocap_program,
      control_program;  // if kStarted; the first is plant or px4

  std::uintmax_t record_bytes() const;  // size of the record's files, estimated from duration and rates
  std::filesystem::path trace_file() const { return folder / "trace.csv"; }
  std::vector<std::filesystem::path> input_files() const;
};

// Throws io::ConfigError or InputError if the input is invalid or if the vehicle cannot fly the mission, by a dry run
// (mission_check.hpp), with what would make it possible. Of kAttached the place is not known yet: the mission is
// not flown in a dry run, and planned_duration_s is 0. Starts no process and writes no file.
LaunchConfiguration plan_flight(const FlyOptions& options);

// The duration of the mission of the plan, s, from plan.start_ned. Throws InputError if its vehicle cannot fly it, as above.
double require_flyable(const LaunchConfiguration& plan, const io::FileOptions& reading);

// flights/<date-time>-<name>
std::filesystem::path default_record_folder(const std::string& name);

ExistingRecord existing_record(const FlyOptions& options);

// Samples the vehicle and simulation to fly with this seed; the controller is designed for plan.vehicle.
// Throws as draw() of dispersion.hpp does.
simulation::DispersionSample draw(const LaunchConfiguration& plan, std::uint64_t seed);

// The vehicles of one command, with the i-th plan for the i-th name. They differ in vehicle file, mission, seed and start
// only. Vehicles of one file have consecutive seeds in their order.
struct Fleet {
  std::vector<std::string> vehicles;
  std::vector<LaunchConfiguration> plans;
  std::filesystem::path folder;  // of the record; that of the plan of a single vehicle
  std::string program;           // with its version, for the record
};

// Where the i-th of several vehicles starts, m: in rows about the origin.
Eigen::Vector2d start_of(std::size_t i, std::size_t vehicles, double spacing_m, int per_row);

// The processes that serve a fleet of kStarted, on this network: plant and control for each vehicle file, and motion
// capture for all. Empty for other launch modes.
std::vector<io::ProcessSettings> processes(const Fleet& fleet, const dds::NodeSettings& network);

// A report with the fields of the plan filled in.
analysis::FlightReport report_of(const LaunchConfiguration& plan);

}  // namespace swiftlet::ground

// The subcommands of `swiftlet` and its programs: each function adds one to the command line and returns what runs it.
#pragma once

#include <string>

#include "swiftlet/io/command_line/command.hpp"

namespace swiftlet::ground {

// Starts the processes, flies a mission and reports. version: of the program, for the record.
io::Command add_fly_command(runtime::CommandLine root, const std::string& version = "swiftlet");

// Requests to, and state of, a vehicle that already runs.
io::Command add_arm_command(runtime::CommandLine root);
io::Command add_disarm_command(runtime::CommandLine root);
io::Command add_takeoff_command(runtime::CommandLine root);
io::Command add_goto_command(runtime::CommandLine root);
io::Command add_land_command(runtime::CommandLine root);
io::Command add_hold_command(runtime::CommandLine root);
io::Command add_stop_command(runtime::CommandLine root);
io::Command add_mission_command(runtime::CommandLine root);
io::Command add_mission_upload_command(runtime::CommandLine mission);
io::Command add_mission_start_command(runtime::CommandLine mission);
io::Command add_mission_pause_command(runtime::CommandLine mission);
io::Command add_mission_resume_command(runtime::CommandLine mission);
io::Command add_mission_skip_command(runtime::CommandLine mission);
io::Command add_mission_clear_command(runtime::CommandLine mission);
io::Command add_trajectory_command(runtime::CommandLine root);
io::Command add_stream_command(runtime::CommandLine root);
io::Command add_teleop_command(runtime::CommandLine root);
io::Command add_set_command(runtime::CommandLine root);  // `set control`
io::Command add_status_command(runtime::CommandLine root);
io::Command add_watch_command(runtime::CommandLine root);
io::Command add_list_command(runtime::CommandLine root);  // all vehicles of the domain
io::Command add_view_command(runtime::CommandLine root, const std::string& version = "swiftlet");

// Motion capture, without a vehicle's processes: `mocap list`, `mocap watch`, `mocap calibrate`.
io::Command add_mocap_command(runtime::CommandLine root);

// The network.
io::Command add_discovery_server_command(runtime::CommandLine root);
io::Command add_doctor_command(runtime::CommandLine root);  // `doctor network`
io::Command add_doctor_network_command(runtime::CommandLine doctor);

// Tests a connected vehicle without flying: `check vehicle`.
io::Command add_check_command(runtime::CommandLine root);
io::Command add_check_vehicle_command(runtime::CommandLine check);

// Recorded flights.
io::Command add_record_command(runtime::CommandLine root, const std::string& version = "swiftlet");
io::Command add_log_command(runtime::CommandLine root);  // `log info`, `log cut`, `log csv` ...
io::Command add_report_command(runtime::CommandLine root);

// Named configuration files: `config ls`, `config show`.
io::Command add_config_command(runtime::CommandLine root);

// Keys that protect a network: `keys network`.
io::Command add_keys_command(runtime::CommandLine root);

// Shell completion and manual pages.
io::Command add_completion_command(runtime::CommandLine root);
io::Command add_manual_command(runtime::CommandLine root);

// Several vehicles in one room: `fleet check`, `fleet fly`. version: of the program, for the record.
io::Command add_fleet_command(runtime::CommandLine root, const std::string& version = "swiftlet");

// Groups with commands in several programs.
constexpr const char* kSimPurpose = "Simulate without DDS, in one process";
constexpr const char* kMissionPurpose = "Check a mission file, draw it, and fly it with a running vehicle";

// Controller design, mission checks and simulation.
io::Command add_tune_command(runtime::CommandLine root);  // `tune plot`
io::Command add_gains_command(runtime::CommandLine root);
io::Command add_mission_check_command(runtime::CommandLine mission);
io::Command add_mission_plot_command(runtime::CommandLine mission);
io::Command add_sim_command(runtime::CommandLine root, const std::string& version = "swiftlet");
io::Command add_sim_fly_command(runtime::CommandLine sim, const std::string& version);
io::Command add_sim_batch_command(runtime::CommandLine sim, const std::string& version);
io::Command add_sim_merge_command(runtime::CommandLine sim);
io::Command add_sim_open_loop_command(runtime::CommandLine sim);

}  // namespace swiftlet::ground

// The subcommands of `swiftlet`, one file each.
#pragma once

#include "ground/command.hpp"

namespace swiftlet::ground {

// A flight from one command: the processes, the mission, the report.
Command add_fly_command(CLI::App& root);

// Asked of a vehicle that runs already.
Command add_arm_command(CLI::App& root);
Command add_disarm_command(CLI::App& root);
Command add_takeoff_command(CLI::App& root);
Command add_goto_command(CLI::App& root);
Command add_land_command(CLI::App& root);
Command add_hold_command(CLI::App& root);
Command add_stop_command(CLI::App& root);
Command add_mission_command(CLI::App& root);
Command add_mission_fly_command(CLI::App& mission);
Command add_mission_upload_command(CLI::App& mission);
Command add_mission_start_command(CLI::App& mission);
Command add_mission_pause_command(CLI::App& mission);
Command add_mission_resume_command(CLI::App& mission);
Command add_mission_skip_command(CLI::App& mission);
Command add_mission_clear_command(CLI::App& mission);
Command add_trajectory_command(CLI::App& root);
Command add_stream_command(CLI::App& root);
Command add_status_command(CLI::App& root);
Command add_watch_command(CLI::App& root);
Command add_list_command(CLI::App& root);  // of all vehicles

// What was flown.
Command add_report_command(CLI::App& root);

// What is to be flown, from bench data or from flights.
Command add_identify_command(CLI::App& root);
Command add_identify_flight_command(CLI::App& identify);
Command add_identify_simulate_command(CLI::App& identify);

// Of this program itself.
Command add_completion_command(CLI::App& root);
Command add_manual_command(CLI::App& root);

// What will be flown, without flying.
Command add_gains_command(CLI::App& root);
Command add_mission_check_command(CLI::App& mission);
Command add_mission_plot_command(CLI::App& mission);
Command add_sim_command(CLI::App& root);
Command add_sim_fly_command(CLI::App& sim);
Command add_sim_batch_command(CLI::App& sim);
Command add_sim_open_loop_command(CLI::App& sim);

}  // namespace swiftlet::ground

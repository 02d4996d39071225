// The subcommands of `swiftlet`, one file each.
#pragma once

#include "swiftlet/ground/command_line/command.hpp"

namespace swiftlet::ground {

// A flight from one command: the processes, the mission, the report.
Command add_fly_command(runtime::CommandLine root);

// Asked of a vehicle that runs already.
Command add_arm_command(runtime::CommandLine root);
Command add_disarm_command(runtime::CommandLine root);
Command add_takeoff_command(runtime::CommandLine root);
Command add_goto_command(runtime::CommandLine root);
Command add_land_command(runtime::CommandLine root);
Command add_hold_command(runtime::CommandLine root);
Command add_stop_command(runtime::CommandLine root);
Command add_mission_command(runtime::CommandLine root);
Command add_mission_fly_command(runtime::CommandLine mission);
Command add_mission_upload_command(runtime::CommandLine mission);
Command add_mission_start_command(runtime::CommandLine mission);
Command add_mission_pause_command(runtime::CommandLine mission);
Command add_mission_resume_command(runtime::CommandLine mission);
Command add_mission_skip_command(runtime::CommandLine mission);
Command add_mission_clear_command(runtime::CommandLine mission);
Command add_trajectory_command(runtime::CommandLine root);
Command add_stream_command(runtime::CommandLine root);
Command add_status_command(runtime::CommandLine root);
Command add_watch_command(runtime::CommandLine root);
Command add_list_command(runtime::CommandLine root);  // of all vehicles

// What was flown.
Command add_report_command(runtime::CommandLine root);

// What is to be flown, from bench data or from flights.
Command add_identify_command(runtime::CommandLine root, char** argv);  // becomes `swiftlet-identify`

// Of this program itself.
Command add_completion_command(runtime::CommandLine root);
Command add_manual_command(runtime::CommandLine root);

// What will be flown, without flying.
Command add_gains_command(runtime::CommandLine root);
Command add_mission_check_command(runtime::CommandLine mission);
Command add_mission_plot_command(runtime::CommandLine mission);
Command add_sim_command(runtime::CommandLine root);
Command add_sim_fly_command(runtime::CommandLine sim);
Command add_sim_batch_command(runtime::CommandLine sim);
Command add_sim_open_loop_command(runtime::CommandLine sim);

}  // namespace swiftlet::ground

// swiftlet-analysis: the commands of `swiftlet` about records, models and settings, which need no running vehicle.
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/services/runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  return io::run_commands(argc, argv, runtime::version_text(), [](runtime::CommandLine root) {
    const runtime::CommandLine sim = root.add_subcommand("sim", ground::kSimPurpose);
    const std::vector<io::Command> simulations = {ground::add_sim_batch_command(sim, runtime::version_text()),
                                                  ground::add_sim_merge_command(sim),
                                                  ground::add_sim_open_loop_command(sim)};
    const runtime::CommandLine mission = root.add_subcommand("mission", ground::kMissionPurpose);
    const io::Command plot = ground::add_mission_plot_command(mission);
    return std::vector<io::Command>{
        ground::add_log_command(root),
        ground::add_report_command(root),
        ground::add_gains_command(root),
        ground::add_tune_command(root),
        {sim, [simulations] { return io::run_given(simulations); }},
        {mission, plot.run},
    };
  });
}

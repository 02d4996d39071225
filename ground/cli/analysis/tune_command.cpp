// `swiftlet tune`: control settings before a flight.
#include <vector>

#include "swiftlet/ground/cli/analysis/tune_commands.hpp"
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_tune_command(runtime::CommandLine root) {
  const runtime::CommandLine tune = root.add_subcommand("tune", io::purpose_of("tune"));
  tune.require_subcommand(1, 1);
  tune.footer("example: swiftlet tune plot motor_lag paper");
  const std::vector<io::Command> commands = {add_tune_plot_command(tune), add_tune_delay_command(tune)};
  return {tune, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground

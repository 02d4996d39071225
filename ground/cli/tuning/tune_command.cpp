// `swiftlet tune`: control settings before a flight.
#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/cli/tuning/tune_commands.hpp"

namespace swiftlet::ground {

Command add_tune_command(runtime::CommandLine root) {
  const runtime::CommandLine tune =
      root.add_subcommand("tune", "Compare and make control settings before flight");
  tune.require_subcommand(1, 1);
  tune.footer("example: swiftlet tune plot motor_lag paper");
  const Command plot = add_tune_plot_command(tune);
  const Command delay = add_tune_delay_command(tune);
  return {tune, [plot, delay] { return plot.app.parsed() ? plot.run() : delay.run(); }};
}

}  // namespace swiftlet::ground

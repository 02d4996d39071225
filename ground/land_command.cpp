
#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : AskOptions {
  double speed = 0.4;
};

}  // namespace

Command add_land_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_ask_subcommand(
      root, "land", "Descend straight down and stop the rotors", "swiftlet land --speed 0.3", options);
  app.add_option("--speed", options->speed, "peak speed, m/s").positive().show_default();
  return {app, [options] {
            return run_request(*options, "land", [&](Vehicle& vehicle) {
              return vehicle.land(options->speed, options->timeout());
            });
          }};
}

}  // namespace swiftlet::ground

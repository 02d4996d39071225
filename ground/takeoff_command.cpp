
#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : AskOptions {
  double height_m = 1.0;
  double speed = 0.5;
};

}  // namespace

Command add_takeoff_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_ask_subcommand(
      root, "takeoff", "Climb straight up and hold; arm first", "swiftlet takeoff 1.2 --speed 0.5", options);
  app.add_option("height", options->height_m, "height above the origin, m").positive().show_default();
  app.add_option("--speed", options->speed, "peak speed, m/s").positive().show_default();
  return {app, [options] {
            return run_request(*options, "takeoff", [&](Vehicle& vehicle) {
              return vehicle.take_off(options->height_m, options->speed, options->timeout());
            });
          }};
}

}  // namespace swiftlet::ground

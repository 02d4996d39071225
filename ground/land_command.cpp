#include <CLI/CLI.hpp>

#include "ground/commands.hpp"
#include "ground/numbers.hpp"
#include "ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : RequestOptions {
  double speed = 0.4;
};

}  // namespace

Command add_land_command(CLI::App& root) {
  const auto options = std::make_shared<Options>();
  CLI::App* const app = add_request_subcommand(root, "land", "Descend straight down and stop the rotors",
                                               "swiftlet land --speed 0.3", options);
  app->add_option("--speed", options->speed, "peak speed, m/s")
      ->check(positive_number())
      ->capture_default_str();
  return {app, [options] {
            return run_request(*options, "land", [&](Client& client) {
              msg::Command command;
              command.kind(msg::Command_Constants::LAND);
              command.speed(options->speed);
              return client.command(command, milliseconds(options->timeout_s));
            });
          }};
}

}  // namespace swiftlet::ground

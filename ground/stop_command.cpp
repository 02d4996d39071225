#include <cstdio>
#include <iostream>
#include <string>
#include <unistd.h>

#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {
namespace {

struct Options : AskOptions {
  bool yes = false;
};

// At a terminal only: a script says --yes.
void confirm(const Options& options) {
  if (options.yes) return;
  if (isatty(STDIN_FILENO) == 0 || isatty(STDERR_FILENO) == 0)
    throw InputError(
        "stop: the rotors go off in the air too, and the vehicle falls; without a terminal say --yes");
  const bool one = split_list(options.network.vehicle).size() == 1;
  std::fprintf(stderr, "Rotors off at once, wherever %s %s: in the air %s. Type stop to do it: ",
               options.network.vehicle.c_str(), one ? "is" : "are", one ? "it falls" : "they fall");
  std::string typed;
  std::getline(std::cin, typed);
  if (typed != "stop") throw InputError("stop: not confirmed, nothing was sent");
}

}  // namespace

Command add_stop_command(runtime::CommandLine root) {
  const auto options = std::make_shared<Options>();
  const runtime::CommandLine app = add_ask_subcommand(
      root, "stop", "Emergency: rotors off at once, wherever it is", "swiftlet stop --yes", options);
  app.add_flag("--yes,-y", options->yes, "do not ask for confirmation");
  return {app, [options] {
            confirm(*options);
            return run_request(*options, "stop",
                               [&](Vehicle& vehicle) { return vehicle.stop(options->timeout()); });
          }};
}

}  // namespace swiftlet::ground

#include "ground/commands.hpp"
#include "ground/request_command.hpp"

namespace swiftlet::ground {

Command add_stop_command(CLI::App& root) {
  return add_plain_request_command(root, "stop", "Emergency: rotors off at once, wherever it is",
                                   msg::Command_Constants::STOP);
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {

Command add_disarm_command(runtime::CommandLine root) {
  return add_plain_request_command(root, "disarm", "Stop the rotors on the ground", &Vehicle::disarm);
}

}  // namespace swiftlet::ground

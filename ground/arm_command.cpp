#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {

Command add_arm_command(runtime::CommandLine root) {
  return add_plain_request_command(
      root, "arm", "Start the rotors turning on the ground, once all checks pass", &Vehicle::arm);
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/commands.hpp"
#include "swiftlet/ground/request_command.hpp"

namespace swiftlet::ground {

Command add_hold_command(runtime::CommandLine root) {
  return add_plain_request_command(root, "hold", "Stop where it is and stay there", &Vehicle::hold);
}

}  // namespace swiftlet::ground

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_check_command(runtime::CommandLine root) {
  const runtime::CommandLine check = root.add_subcommand("check", io::purpose_of("check"));
  check.require_subcommand(1, 1);
  const io::Command vehicle = add_check_vehicle_command(check);
  return {check, vehicle.run};
}

}  // namespace swiftlet::ground

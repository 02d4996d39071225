#include "swiftlet/ground/cli/commands.hpp"

namespace swiftlet::ground {

Command add_check_command(runtime::CommandLine root) {
  const runtime::CommandLine check =
      root.add_subcommand("check", "Test a part of the system against its contract");
  check.require_subcommand(1, 1);
  const Command vehicle = add_check_vehicle_command(check);
  return {check, vehicle.run};
}

}  // namespace swiftlet::ground

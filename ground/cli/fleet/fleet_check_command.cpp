#include <cstdio>
#include <string>

#include "swiftlet/ground/cli/fleet/fleet_commands.hpp"
#include "swiftlet/ground/fleet/fleet_check.hpp"
#include "swiftlet/io/configuration.hpp"

namespace swiftlet::ground {
namespace {

struct FleetCheckOptions {
  std::string file;
  bool json = false;
};

// The name of the vehicle, and that of its mission if it is another one.
std::string name_of(const FleetVehicle& one) {
  const std::string& vehicle = one.member.name;
  return one.mission.name == vehicle ? vehicle : vehicle + ": " + one.mission.name;
}

int check_fleet_file(const FleetCheckOptions& options) {
  const FleetCheck check =
      check_fleet(load_fleet_file(io::configuration_file(io::kinds::kFleet, options.file)));
  for (const FleetVehicle& one : check.vehicles) {
    for (const std::string& assumption : one.mission.assumptions)
      std::fprintf(stderr, "%s: %s\n", name_of(one).c_str(), assumption.c_str());
  }
  std::printf("%s", options.json ? (check_json(check) + "\n").c_str() : check_table(check).c_str());
  return check.feasible() ? io::kDone : io::kFailed;
}

}  // namespace

io::Command add_fleet_check_command(runtime::CommandLine fleet) {
  const auto options = std::make_shared<FleetCheckOptions>();
  const runtime::CommandLine app = fleet.add_subcommand(
      "check",
      "Check whether each vehicle of a fleet file can fly its mission, and whether all pairs stay apart");
  app.footer(
      "example: swiftlet fleet check swap6\nExit codes: 0 the fleet can be flown, 1 it cannot, 2 a file is "
      "invalid.");
  app.add_option("file", options->file, "fleet file, or the name of one in config/fleets")
      .type_name(io::kinds::kFleet.value)
      .required();
  app.add_flag("--json", options->json, "print JSON");
  return {app, [options] { return check_fleet_file(*options); }};
}

}  // namespace swiftlet::ground

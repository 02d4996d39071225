#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_doctor_command(runtime::CommandLine root) {
  const runtime::CommandLine doctor = root.add_subcommand("doctor", io::purpose_of("doctor"));
  doctor.require_subcommand(1, 1);
  const io::Command network = add_doctor_network_command(doctor);
  return {doctor, network.run};
}

}  // namespace swiftlet::ground

#include <cerrno>
#include <string>
#include <system_error>
#include <unistd.h>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/ground/command_line/installation.hpp"
#include "swiftlet/ground/identify/identify_options.hpp"

namespace swiftlet::ground {

Command add_identify_command(runtime::CommandLine root, char** argv) {
  const auto execute_program = [argv](const auto&) -> int {
    const std::string program = program_beside("swiftlet-identify").string();
    execv(program.c_str(), argv + 1);  // argv[0] of the new program is the name of the command
    throw std::system_error(errno, std::generic_category(), program);
  };
  const runtime::CommandLine app = root.add_subcommand("identify", kIdentifyPurpose);
  return add_identify_options(app, {execute_program, execute_program, execute_program});
}

}  // namespace swiftlet::ground

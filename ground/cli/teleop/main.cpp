// swiftlet-teleop: `swiftlet teleop`.
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/services/runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  return io::run_commands(argc, argv, runtime::version_text(), [](runtime::CommandLine root) {
    return std::vector<io::Command>{ground::add_teleop_command(root)};
  });
}

// swiftlet-identify: `swiftlet identify`. The only program that links the fitting libraries.
#include "swiftlet/analysis/identify/identify_options.hpp"
#include "swiftlet/io/command_line/programs.hpp"
#include "swiftlet/services/runtime/version.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  return io::run_commands(argc, argv, runtime::version_text(), [](runtime::CommandLine root) {
    return std::vector<io::Command>{analysis::add_identify_command(root)};
  });
}

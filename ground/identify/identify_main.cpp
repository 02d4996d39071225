// swiftlet-identify: the program behind `swiftlet identify`.
#include "swiftlet/ground/command_line/run_command_line.hpp"
#include "swiftlet/ground/identify/identify_actions.hpp"

int main(int argc, char** argv) {
  using namespace swiftlet;
  runtime::Program program("swiftlet identify", ground::kIdentifyPurpose);
  const ground::Command command = ground::add_identify_options(
      program.command_line(), {ground::identify_bench, ground::identify_flight, ground::identify_simulate});
  return ground::run_command_line(program, argc, argv, command.run);
}

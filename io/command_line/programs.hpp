// The programs behind `swiftlet`. What a flight needs is in `swiftlet` itself; it executes another program for the rest, as git does.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "swiftlet/io/command_line/command.hpp"
#include "swiftlet/io/command_line/command_text.hpp"

namespace swiftlet::io {

// A command that another program carries out, with the same arguments.
struct ProgramCommand {
  std::string words;    // "sim batch"
  const char* program;  // in the folder of `swiftlet`
  const char* purpose;
};
const std::vector<ProgramCommand>& program_commands();

// The command that these arguments of `swiftlet` begin with; nullptr if `swiftlet` itself carries them out.
const ProgramCommand* program_command_of(int argc, const char* const* argv);

// Executes the command's program in place of this one, with these arguments. Returns only if that fails: an exit code, after a
// sentence on standard error.
int execute_program(const ProgramCommand& command, char** argv);

// What the command is for, as listed in program_commands(). command: "sim batch".
const char* purpose_of(const std::string& command);

// Adds the commands of the other programs to those of `swiftlet`, for its help. They have no options there.
void add_program_commands(runtime::CommandLine root);

// The commands of `swiftlet` with those of the other programs. Those that are installed are asked for their options.
CommandText text_of_all_programs(runtime::CommandLine root);

// main() of `swiftlet` and of its programs: adds the commands, runs the one that the arguments name, and returns its exit code.
// version: of --version.
int run_commands(int argc, char** argv, const char* version,
                 const std::function<std::vector<Command>(runtime::CommandLine root)>& add_commands);

}  // namespace swiftlet::io

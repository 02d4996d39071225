#include "swiftlet/io/command_line/programs.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <set>
#include <stdexcept>
#include <system_error>
#include <unistd.h>

#include "swiftlet/io/command_line/installation.hpp"
#include "swiftlet/io/command_line/run_command_line.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

constexpr const char* kCommandTextOption = "--command-text";  // prints the commands of a program as JSON

// What the program prints. Throws std::runtime_error if it fails.
std::string output_of(const std::filesystem::path& program) {
  const auto close = [](std::FILE* pipe) { return pclose(pipe); };
  std::unique_ptr<std::FILE, decltype(close)> pipe(
      popen(("exec " + shell_quoted(program.string()) + " " + kCommandTextOption).c_str(), "r"), close);
  if (!pipe) throw std::system_error(errno, std::generic_category(), program.string());
  std::string text;
  std::array<char, 4096> block{};
  for (std::size_t got = 0; (got = std::fread(block.data(), 1, block.size(), pipe.get())) > 0;)
    text.append(block.data(), got);
  if (const int status = pclose(pipe.release()); status != 0)
    throw std::runtime_error(program.string() + " " + kCommandTextOption + " failed");
  return text;
}

// The command of these words, such as "sim batch"; nullptr if the program has none.
CommandText* find(CommandText& program, const std::string& words) {
  CommandText* found = &program;
  for (const std::string& word : io::split_text(words, ' ')) {
    if (found == nullptr) break;
    auto& commands = found->commands;
    const auto next = std::find_if(commands.begin(), commands.end(),
                                   [&](const CommandText& one) { return one.words.back() == word; });
    found = next == commands.end() ? nullptr : &*next;
  }
  return found;
}

}  // namespace

const std::vector<ProgramCommand>& program_commands() {
  static const std::vector<ProgramCommand> commands = {
      {"log", "swiftlet-analysis",
       "Inspect, cut, merge, repair, export, compare and replay recorded MCAP files"},
      {"report", "swiftlet-analysis", "Report recorded flights, and the settings in which they differ"},
      {"gains", "swiftlet-analysis", "Print the gains, poles and margins for a vehicle and control settings"},
      {"tune", "swiftlet-analysis", "Compare and make control settings before flight"},
      {"sim batch", "swiftlet-analysis",
       "Fly a mission many times, with sampled vehicles and simulations (Monte Carlo)"},
      {"sim merge", "swiftlet-analysis", "Join the shards of a batch into the result of the whole batch"},
      {"sim open-loop", "swiftlet-analysis", "Simulate the response to pulse widths, without a controller"},
      {"mission plot", "swiftlet-analysis", "Plot the path of a mission file with its limits and fence"},
      {"identify", "swiftlet-identify", "Identify a vehicle from test bench data, or from flights"},
      {"fleet", "swiftlet-fleet",
       "Check and fly several vehicles in one room, from a fleet file; command running ones"},
      {"teleop", "swiftlet-teleop", "Fly by the keys of the terminal, or with a gamepad"},
      {"view", "swiftlet-view",
       "Serve a live page of running vehicles, which is also a server for Foxglove and PlotJuggler"},
      {"check", "swiftlet-check", "Test a part of the system against its contract"},
      {"mocap", "swiftlet-mocap-tool",
       "Show what a motion capture sends, and calibrate its bodies"},  // swiftlet-mocap is the service
      {"doctor", "swiftlet-network", "Examine what a flight depends on"},
      {"discovery-server", "swiftlet-network",
       "Tell the processes of a domain of each other, where multicast does not reach"},
      {"keys", "swiftlet-network", "Make the keys that protect a network"},
  };
  return commands;
}

const ProgramCommand* program_command_of(int argc, const char* const* argv) {
  const std::string first = argc > 1 ? argv[1] : "";
  const std::string second = argc > 2 ? first + " " + argv[2] : first;
  for (const ProgramCommand& command : program_commands()) {
    if (command.words == first || command.words == second) return &command;
  }
  return nullptr;
}

const char* purpose_of(const std::string& command) {
  for (const ProgramCommand& one : program_commands()) {
    if (one.words == command) return one.purpose;
  }
  throw std::logic_error("'" + command + "' is not listed in program_commands()");
}

void add_program_commands(runtime::CommandLine root) {
  for (const ProgramCommand& command : program_commands()) {
    const std::vector<std::string> words = io::split_text(command.words, ' ');
    runtime::CommandLine above = root;
    for (std::size_t i = 0; i + 1 < words.size(); ++i) above = above.subcommand(words[i]);
    above.add_subcommand(words.back(), command.purpose);
  }
}

CommandText text_of_all_programs(runtime::CommandLine root) {
  CommandText all = command_text(root);
  std::set<std::string> programs;
  for (const ProgramCommand& command : program_commands()) programs.insert(command.program);
  for (const std::string& program : programs) {
    if (!has_program_beside(program)) continue;  // its commands remain without options
    CommandText text = command_text_of_json(output_of(program_beside(program)));
    for (const ProgramCommand& command : program_commands()) {
      CommandText* const found = command.program == program ? find(text, command.words) : nullptr;
      if (found != nullptr) *find(all, command.words) = *found;
    }
  }
  return all;
}

int execute_program(const ProgramCommand& command, char** argv) {
  return run_reporting_errors([&]() -> int {
    const std::string program = program_beside(command.program).string();
    execv(program.c_str(), argv);
    throw std::system_error(errno, std::generic_category(), program);
  });
}

int run_commands(int argc, char** argv, const char* version,
                 const std::function<std::vector<Command>(runtime::CommandLine root)>& add_commands) {
  runtime::Program program("swiftlet", "Swiftlet: fly micro quadrotors over DDS");
  program.add_version(version);
  const runtime::CommandLine root = program.command_line();
  root.require_subcommand(0, 1);
  root.footer(
      "example: swiftlet fly square\n`swiftlet COMMAND --help` explains a command.\nExit codes: 0 success, 1 "
      "failed or refused, 2 bad input.");
  const std::vector<Command> commands = add_commands(root);
  if (argc == 2 && std::strcmp(argv[1], kCommandTextOption) == 0) {
    std::puts(json_of(command_text(root)).c_str());
    return kDone;
  }
  std::signal(SIGXFSZ, SIG_IGN);  // a limit of a file's size is an error of write(), as a full disk is
  return run_command_line(program, argc, argv, [&] {
    const bool given = std::any_of(commands.begin(), commands.end(),
                                   [](const Command& command) { return command.app.parsed(); });
    if (given) return run_given(commands);
    std::fprintf(stderr, "%s\nswiftlet: a command is required\n", root.help().c_str());
    return kBadInput;
  });
}

}  // namespace swiftlet::io

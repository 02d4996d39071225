#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/atomic_write.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {
namespace {

struct ManualOptions {
  std::vector<std::string> command;
  std::string folder;
};

void write_all(const io::CommandText& command, const std::filesystem::path& folder) {
  io::write_atomically(folder / (io::manual_page_name(command) + ".1"), io::manual_page(command));
  for (const io::CommandText& sub : command.commands) write_all(sub, folder);
}

const io::CommandText& find(const io::CommandText& program, const std::vector<std::string>& words) {
  const io::CommandText* found = &program;
  for (const std::string& word : words) {
    const auto sub =
        std::find_if(found->commands.begin(), found->commands.end(),
                     [&](const io::CommandText& candidate) { return candidate.words.back() == word; });
    if (sub == found->commands.end())
      throw io::InputError("man: " + word + " is not a command of " + io::manual_page_name(*found));
    found = &*sub;
  }
  return *found;
}

int write_manual(runtime::CommandLine root, const ManualOptions& options) {
  const io::CommandText program = io::text_of_all_programs(root);
  if (options.folder.empty()) {
    std::fputs(io::manual_page(find(program, options.command)).c_str(), stdout);
    return io::kDone;
  }
  std::filesystem::create_directories(options.folder);
  write_all(program, options.folder);
  return io::kDone;
}

}  // namespace

io::Command add_manual_command(runtime::CommandLine root) {
  const auto options = std::make_shared<ManualOptions>();
  const runtime::CommandLine app =
      root.add_subcommand("man", "Print the manual page of this program or of a command");
  app.add_option("command", options->command, "command, such as: sim fly; default: the program itself");
  app.add_option("--into", options->folder, "folder to which the pages of all commands are written");
  app.footer("example: swiftlet man sim fly | man -l -");
  return {app, [root, options] { return write_manual(root, *options); }};
}

}  // namespace swiftlet::ground

#include <cstdio>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/command_line/programs.hpp"

namespace swiftlet::ground {

io::Command add_completion_command(runtime::CommandLine root) {
  const auto shell = std::make_shared<std::string>();
  const runtime::CommandLine app =
      root.add_subcommand("completion", "Print the completion script for a shell");
  app.add_option("shell", *shell, "shell that loads the script").required().one_of({"bash", "zsh"});
  app.footer("example: source <(swiftlet completion bash)");
  return {app, [root, shell] {
            const io::CommandText program = io::text_of_all_programs(root);
            std::fputs((*shell == "zsh" ? io::zsh_completion(program) : io::bash_completion(program)).c_str(),
                       stdout);
            return io::kDone;
          }};
}

}  // namespace swiftlet::ground

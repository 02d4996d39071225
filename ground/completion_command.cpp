#include <cstdio>

#include <CLI/CLI.hpp>

#include "ground/command_text.hpp"
#include "ground/commands.hpp"

namespace swiftlet::ground {

Command add_completion_command(CLI::App& root) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* const app =
      root.add_subcommand("completion", "Print the script that completes this command in a shell");
  app->add_option("shell", *shell, "for which shell")->required()->check(CLI::IsMember({"bash", "zsh"}));
  app->footer("example: source <(swiftlet completion bash)");
  return {app, [&root, shell] {
            const CommandText program = command_text(root);
            std::fputs((*shell == "zsh" ? zsh_completion(program) : bash_completion(program)).c_str(),
                       stdout);
            return kDone;
          }};
}

}  // namespace swiftlet::ground

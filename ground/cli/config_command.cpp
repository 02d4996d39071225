// `swiftlet config`: `ls` lists the configuration files that have a name, `show` prints one and where it lies.
#include <cctype>
#include <cstdio>
#include <string>
#include <vector>

#include "swiftlet/ground/cli/commands.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/text_file.hpp"

namespace swiftlet::ground {
namespace {

struct ListOptions {
  std::string kind;  // a folder; empty: all
  bool names = false;
};

struct ShowOptions {
  std::string name;
  bool path = false;
};

// The first sentence, without its full stop. "Fig. 8" does not end one.
std::string first_sentence(const std::string& text) {
  std::size_t end = text.find(". ");
  while (end != std::string::npos && std::isdigit(static_cast<unsigned char>(text[end + 2])) != 0)
    end = text.find(". ", end + 1);
  const std::string sentence = text.substr(0, end);
  return sentence.substr(0, sentence.find_last_not_of(" .:,") + 1);
}

int list(const ListOptions& options) {
  for (const io::ConfigurationKind& kind : io::configuration_kinds()) {
    if (!options.kind.empty() && options.kind != kind.folder) continue;
    if (!options.names) std::printf("%s\n", kind.folder);
    for (const io::ConfigurationFile& file : io::configuration_files(kind)) {
      if (options.names) {
        std::printf("%s\n", file.name.c_str());
      } else {
        std::printf("  %-16s %s\n", file.name.c_str(), first_sentence(io::description_of(file.path)).c_str());
      }
    }
  }
  return io::kDone;
}

// Prints all files of this name: a vehicle and a dispersion may have the same.
int show(const ShowOptions& options) {
  std::vector<std::string> names;
  bool found = false;
  for (const io::ConfigurationKind& kind : io::configuration_kinds()) {
    for (const io::ConfigurationFile& file : io::configuration_files(kind)) {
      const std::string full_name = std::string(kind.folder) + "/" + file.name;
      names.insert(names.end(), {file.name, full_name});
      if (options.name != file.name && options.name != full_name) continue;
      found = true;
      if (options.path) {
        std::printf("%s\n", file.path.c_str());
      } else {
        std::printf("# %s\n%s", file.path.c_str(), io::read_text_file(file.path).c_str());
      }
    }
  }
  if (found) return io::kDone;
  throw io::InputError("No configuration file '" + options.name + "'." +
                       io::did_you_mean(names, options.name) + " `swiftlet config ls` lists all");
}

io::Command add_list(runtime::CommandLine config) {
  const auto options = std::make_shared<ListOptions>();
  const runtime::CommandLine app =
      config.add_subcommand("ls", "List the configuration files that have a name");
  std::vector<std::string> kinds;
  for (const io::ConfigurationKind& kind : io::configuration_kinds()) kinds.emplace_back(kind.folder);
  app.add_option("kind", options->kind, "only this kind").one_of(kinds);
  app.add_flag("--names", options->names, "print only the names, one a line");
  app.footer("example: swiftlet config ls missions");
  return {app, [options] { return list(*options); }};
}

io::Command add_show(runtime::CommandLine config) {
  const auto options = std::make_shared<ShowOptions>();
  const runtime::CommandLine app =
      config.add_subcommand("show", "Print a configuration file, after a comment that says where it lies");
  app.add_option("name", options->name, "name, or KIND/NAME").type_name(io::kinds::kAnyValue).required();
  app.add_flag("--path", options->path, "print only where it lies");
  app.footer("example: cp $(swiftlet config show motor_lag --path) mine.yaml");
  return {app, [options] { return show(*options); }};
}

}  // namespace

io::Command add_config_command(runtime::CommandLine root) {
  const runtime::CommandLine config =
      root.add_subcommand("config", "List and print vehicles, control settings, simulations and missions");
  config.require_subcommand(1, 1);
  config.footer("example: swiftlet config ls");
  const std::vector<io::Command> commands = {add_list(config), add_show(config)};
  return {config, [commands] { return io::run_given(commands); }};
}

}  // namespace swiftlet::ground

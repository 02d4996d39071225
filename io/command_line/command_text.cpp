#include "swiftlet/io/command_line/command_text.hpp"

#include <CLI/CLI.hpp>

namespace swiftlet::io {
namespace {

// Parses a CLI11 type such as "TEXT:{realtime,lockstep}" into value, choices and facts.
void read_type(const std::string& type, OptionText& option) {
  const std::size_t colon = type.find(':');
  option.value = type.substr(0, colon);
  if (colon == std::string::npos) return;
  const std::string rule = type.substr(colon + 1);
  const std::size_t open = rule.find('{');
  const std::size_t close = rule.find('}');
  if (open == std::string::npos || close == std::string::npos) {
    option.facts.push_back(rule);
    return;
  }
  for (const std::string& choice : CLI::detail::split(rule.substr(open + 1, close - open - 1), ','))
    option.choices.push_back(choice);
}

OptionText option_text(const CLI::Option& from) {
  OptionText option;
  for (const std::string& name : from.get_lnames()) option.names.push_back("--" + name);
  for (const std::string& name : from.get_snames()) option.names.push_back("-" + name);
  option.positional = from.get_positional();
  if (option.positional) option.names = {from.get_name(true)};
  option.required = from.get_required();
  const bool takes_value = from.get_items_expected_max() > 0;
  if (takes_value) read_type(from.get_type_name(), option);
  if (takes_value && option.value.empty()) option.value = "TEXT";
  option.description = from.get_description();
  if (takes_value && !from.get_default_str().empty())
    option.facts.push_back("default " + from.get_default_str());
  if (!from.get_envname().empty()) option.facts.push_back("environment " + from.get_envname());
  return option;
}

CommandText text_of(const CLI::App& app, const std::vector<std::string>& above) {
  CommandText command;
  command.words = above;
  command.words.push_back(app.get_name());
  command.description = app.get_description();
  command.footer = app.get_footer();
  for (const CLI::Option* const option : app.get_options()) command.options.push_back(option_text(*option));
  for (const CLI::App* const sub : app.get_subcommands([](const CLI::App*) { return true; }))
    command.commands.push_back(text_of(*sub, command.words));
  return command;
}

}  // namespace

CommandText command_text(runtime::CommandLine command) { return text_of(command.app(), {}); }

}  // namespace swiftlet::io

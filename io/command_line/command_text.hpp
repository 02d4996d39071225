// The program's commands and options as data, the source of completion scripts and manual pages.
#pragma once

#include <string>
#include <vector>

#include "swiftlet/services/runtime/command_line.hpp"

namespace swiftlet::io {

struct OptionText {
  std::vector<std::string> names;  // "--json", "-y"; the name of a positional argument
  bool positional = false;
  bool required = false;
  std::string value;                 // type of the value: "TEXT"; empty for a flag
  std::vector<std::string> choices;  // allowed values; empty: any
  std::string description;
  std::vector<std::string> facts;  // "default 0", "INT in [0 - 232]", "environment ROS_DOMAIN_ID"
};

struct CommandText {
  std::vector<std::string> words;  // "swiftlet", "sim", "fly"
  std::string description;
  std::string footer;  // example and exit codes
  std::vector<OptionText> options;
  std::vector<CommandText> commands;
};

// Returns the command with all its subcommands.
CommandText command_text(runtime::CommandLine command);

// The command with all its subcommands as JSON, and back. command_text_of_json() throws std::runtime_error for another text.
std::string json_of(const CommandText& command);
CommandText command_text_of_json(const std::string& text);

std::string bash_completion(const CommandText& program);
std::string zsh_completion(const CommandText& program);

// A page of section 1 in man(7) markup.
std::string manual_page(const CommandText& command);
std::string manual_page_name(const CommandText& command);  // "swiftlet-sim-fly"

}  // namespace swiftlet::io

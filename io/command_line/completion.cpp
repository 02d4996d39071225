// Completion scripts for bash and zsh. Both determine the current command from the words typed so far, and
// look up what may follow it. Names of configuration files and of vehicles that live in the domain are asked of
// the program when they are needed.
#include <functional>

#include "swiftlet/io/command_line/command_text.hpp"
#include "swiftlet/io/configuration.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::io {
namespace {

// "/sim/fly" for `swiftlet sim fly`; "" for the program itself.
std::string path_of(const CommandText& command) {
  std::string path;
  for (std::size_t i = 1; i < command.words.size(); ++i) path += "/" + command.words[i];
  return path;
}

void for_each(const CommandText& command, const std::function<void(const CommandText&)>& visit) {
  visit(command);
  for (const CommandText& sub : command.commands) for_each(sub, visit);
}

// Patterns of a shell `case`, one for each subcommand.
std::string command_patterns(const CommandText& program) {
  std::vector<std::string> patterns;
  for_each(program, [&](const CommandText& command) {
    if (command.words.size() > 1) patterns.push_back(path_of(command));
  });
  return io::joined(patterns, " | ");
}

// "/fly --clock" for each name of an option that takes a value.
std::vector<std::string> value_patterns(const CommandText& command, const OptionText& option) {
  std::vector<std::string> patterns;
  if (option.positional || option.value.empty()) return patterns;
  for (const std::string& name : option.names)
    patterns.push_back("\"" + path_of(command) + " " + name + "\"");
  return patterns;
}

// The arguments with which the program prints the names that the option may have, one a line; "" if it has none.
std::string names_command(const OptionText& option) {
  if (option.names.front() == "--vehicle-name") return "list --names --time 0.5";
  if (option.value == io::kinds::kAnyValue) return "config ls --names";
  for (const io::ConfigurationKind& kind : io::configuration_kinds()) {
    if (option.value == kind.value) return std::string("config ls --names ") + kind.folder;
  }
  return "";
}

// The output of the program with these arguments. program: its path, as the shell has it.
std::string output_of(const std::string& program, const std::string& arguments) {
  return "$(" + program + " " + arguments + " 2> /dev/null)";
}

// Options without a list of choices or names complete as file names; those with names as both. program_word: as
// in output_of(). files: what completes file names; "" if the shell falls back to them.
std::string values_after_options(const CommandText& program, const std::string& program_word,
                                 const char* open, const char* list_begin, const char* list_end,
                                 const char* files) {
  std::string text;
  std::vector<std::string> others;
  for_each(program, [&](const CommandText& command) {
    for (const OptionText& option : command.options) {
      const std::vector<std::string> patterns = value_patterns(command, option);
      if (patterns.empty()) continue;
      const std::string asked = names_command(option);
      const std::string choices =
          asked.empty() ? io::joined(option.choices, " ") : output_of(program_word, asked);
      if (choices.empty()) {
        others.insert(others.end(), patterns.begin(), patterns.end());
      } else {
        text += std::string("    ") + open + io::joined(patterns, " | ") + ") " + list_begin + choices +
                list_end + (asked.empty() ? "" : files) + " return ;;\n";
      }
    }
  });
  if (!others.empty())
    text += std::string("    ") + open + io::joined(others, " | ") + ") " + files + " return ;;\n";
  return text;
}

std::vector<std::string> option_names(const CommandText& command) {
  std::vector<std::string> names;
  for (const OptionText& option : command.options) {
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  }
  return names;
}

std::vector<std::string> plain_words(const CommandText& command) {
  std::vector<std::string> words;
  for (const CommandText& sub : command.commands) words.push_back(sub.words.back());
  for (const OptionText& option : command.options) {
    if (option.positional) words.insert(words.end(), option.choices.begin(), option.choices.end());
  }
  return words;
}

// The names that a positional argument of the command may have, printed by the program.
std::string positional_names(const CommandText& command, const std::string& program_word) {
  std::string names;
  for (const OptionText& option : command.options) {
    const std::string asked = option.positional ? names_command(option) : "";
    if (!asked.empty()) names += (names.empty() ? "" : " ") + output_of(program_word, asked);
  }
  return names;
}

// 'name:description' for zsh's _describe.
std::string described(const std::string& name, const std::string& description) {
  std::string text = "'";
  for (const char c : name) text += c == ':' ? std::string("\\:") : std::string(1, c);
  text += ":";
  for (const char c : description) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

}  // namespace

std::string bash_completion(const CommandText& program) {
  const std::string name = program.words.front();
  const std::string program_word = "\"${COMP_WORDS[0]}\"";
  std::string text =
      "# Completion of " + name + " for bash, written by `" + name + " completion bash`.\n_" + name +
      "() {\n"
      "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} chosen=\"\" i\n"
      "  COMPREPLY=()\n"
      "  if [[ $cur == '=' ]]; then\n"
      "    cur=\"\"\n"
      "  elif [[ $prev == '=' ]]; then\n"
      "    prev=${COMP_WORDS[COMP_CWORD - 2]}\n"
      "  fi\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case \"$chosen/${COMP_WORDS[i]}\" in\n"
      "      " +
      command_patterns(program) +
      ") chosen+=/${COMP_WORDS[i]} ;;\n"
      "    esac\n"
      "  done\n"
      "  case \"$chosen $prev\" in\n" +
      values_after_options(program, program_word, "", "mapfile -t COMPREPLY < <(compgen -W \"",
                           "\" -- \"$cur\");", "") +
      "  esac\n"
      "  local options=\"\" words=\"\"\n"
      "  case \"$chosen\" in\n";
  for_each(program, [&](const CommandText& command) {
    text += "    \"" + path_of(command) + "\")\n      options=\"" + io::joined(option_names(command), " ") +
            "\"\n      words=\"" + io::joined(plain_words(command), " ");
    const std::string names = positional_names(command, program_word);
    text += (names.empty() ? "" : " " + names) + "\"\n      ;;\n";
  });
  return text +
         "  esac\n"
         "  [[ $cur == -* ]] && words=$options\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$cur\")\n"
         "}\n"
         "complete -o bashdefault -o default -F _" +
         name + " " + name + "\n";
}

std::string zsh_completion(const CommandText& program) {
  const std::string name = program.words.front();
  const std::string program_word = "$words[1]";
  std::string text = "#compdef " + name + "\n# Completion of " + name + " for zsh, written by `" + name +
                     " completion zsh`.\n_" + name +
                     "() {\n"
                     "  local cur=$words[CURRENT] prev=$words[CURRENT-1] chosen=\"\" i\n"
                     "  for ((i = 2; i < CURRENT; ++i)); do\n"
                     "    case \"$chosen/$words[i]\" in\n"
                     "      (" +
                     command_patterns(program) +
                     ") chosen+=/$words[i] ;;\n"
                     "    esac\n"
                     "  done\n"
                     "  case \"$chosen $prev\" in\n" +
                     values_after_options(program, program_word, "(", "compadd -- ", ";", " _files;") +
                     "  esac\n"
                     "  local -a options commands names\n"
                     "  case \"$chosen\" in\n";
  for_each(program, [&](const CommandText& command) {
    text += "    (\"" + path_of(command) + "\")\n      options=(\n";
    for (const OptionText& option : command.options) {
      for (const std::string& option_name : option.names) {
        if (!option.positional) text += "        " + described(option_name, option.description) + "\n";
      }
    }
    text += "      )\n      commands=(\n";
    for (const CommandText& sub : command.commands)
      text += "        " + described(sub.words.back(), sub.description) + "\n";
    for (const OptionText& option : command.options) {
      for (const std::string& choice : option.choices) {
        if (option.positional) text += "        " + described(choice, option.description) + "\n";
      }
    }
    text += "      )\n";
    if (const std::string names = positional_names(command, program_word); !names.empty())
      text += "      names=(" + names + ")\n";
    text += "      ;;\n";
  });
  return text +
         "  esac\n"
         "  if [[ $cur == -* ]]; then\n"
         "    _describe option options\n"
         "    return\n"
         "  fi\n"
         "  (( $#commands )) && _describe command commands\n"
         "  (( $#names )) && compadd -- $names\n"
         "  [[ -n $chosen ]] && _files\n"
         "}\n"
         "_" +
         name + " \"$@\"\n";
}

}  // namespace swiftlet::io

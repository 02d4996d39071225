// Manual pages in the markup of man(7).
#include <algorithm>
#include <cctype>
#include <sstream>

#include "swiftlet/io/command_line/command_text.hpp"

namespace swiftlet::io {
namespace {

// Escapes dashes, backslashes, quotes and a dot at the start of a line, so that man(7) prints the text
// literally.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else if (c == '-') {
      out += "\\-";
    } else if (c == '\'' || c == '`' || c == '^' || c == '~') {
      out += c == '\'' ? "\\(aq" : c == '`' ? "\\(ga" : c == '^' ? "\\(ha" : "\\(ti";
    } else {
      out += c;
    }
  }
  return !out.empty() && out.front() == '.' ? "\\&" + out : out;
}

std::string bold(const std::string& text) { return "\\fB" + plain(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + plain(text) + "\\fR"; }

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

std::string value_of(const OptionText& option) {
  std::string choices;
  for (const std::string& choice : option.choices) choices += (choices.empty() ? "" : "|") + choice;
  return choices.empty() ? option.value : choices;
}

std::string synopsis(const CommandText& command) {
  std::string text = bold(spaced(command.words));
  text += " [" + italic("options") + "]";
  for (const OptionText& option : command.options) {
    if (!option.positional) continue;
    const std::string name = italic(option.names.front());
    text += option.required ? " " + name : " [" + name + "]";
  }
  if (!command.commands.empty()) text += " [" + italic("command") + "]";
  return text;
}

std::string paragraph(const OptionText& option) {
  std::string text = ".TP\n";
  for (std::size_t i = 0; i < option.names.size(); ++i)
    text += (i == 0 ? "" : ", ") + (option.positional ? italic(option.names[i]) : bold(option.names[i]));
  if (!option.value.empty() && !option.positional) text += " " + italic(value_of(option));
  text += "\n" + plain(option.description);
  std::vector<std::string> facts = option.facts;
  if (option.positional && !option.choices.empty()) facts.insert(facts.begin(), value_of(option));
  for (std::size_t i = 0; i < facts.size(); ++i) text += (i == 0 ? " (" : "; ") + plain(facts[i]);
  return text + (facts.empty() ? "\n" : ")\n");
}

std::string section(const char* title, const std::vector<OptionText>& options, bool positional) {
  std::string text;
  for (const OptionText& option : options) {
    if (option.positional == positional) text += paragraph(option);
  }
  return text.empty() ? "" : std::string(".SH ") + title + "\n" + text;
}

std::string footer(const std::string& text) {
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.empty()) continue;
    out += out.empty() ? ".SH NOTES\n" : ".br\n";
    out += plain(line) + "\n";
  }
  return out;
}

}  // namespace

std::string manual_page_name(const CommandText& command) {
  std::string name;
  for (const std::string& word : command.words) name += (name.empty() ? "" : "-") + word;
  return name;
}

std::string manual_page(const CommandText& command) {
  const std::string name = manual_page_name(command);
  std::string text = ".TH " + upper(name) + " 1 \"\" \"Swiftlet\" \"Swiftlet\"\n.SH NAME\n" + plain(name) +
                     " \\- " + plain(command.description) + "\n.SH SYNOPSIS\n" + synopsis(command) + "\n";
  text += section("ARGUMENTS", command.options, true);
  text += section("OPTIONS", command.options, false);
  if (!command.commands.empty()) text += ".SH COMMANDS\n";
  for (const CommandText& sub : command.commands)
    text += ".TP\n" + bold(spaced(sub.words)) + "\n" + plain(sub.description) + "\n";
  text += footer(command.footer);
  text += ".SH EXIT STATUS\n0 success; 1 the command failed or was refused; 2 wrong usage or bad input.\n";
  if (command.words.size() > 1) {
    CommandText above;
    above.words.assign(command.words.begin(), command.words.end() - 1);
    text += ".SH SEE ALSO\n" + bold(manual_page_name(above)) + "(1)\n";
  }
  return text;
}

}  // namespace swiftlet::io

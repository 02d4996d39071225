#include "swiftlet/services/runtime/command_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <optional>
#include <sstream>
#include <sys/ioctl.h>
#include <type_traits>
#include <unistd.h>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "swiftlet/io/nearest_name.hpp"
#include "swiftlet/io/text.hpp"

namespace swiftlet::runtime {
namespace {

using Words = std::vector<std::string>;

// Names the environment variable instead of the option of the command whose value came from it. words: that were given.
std::string with_source(const CLI::App& app, const std::string& fault, const Words& words) {
  for (const CLI::Option* const option : app.get_options()) {
    const std::string& name = option->get_name();
    const bool is_given = std::any_of(words.begin(), words.end(), [&](const std::string& word) {
      return word == name || word.rfind(name + "=", 0) == 0;
    });
    if (!option->get_envname().empty() && !is_given && fault.rfind(name + ": ", 0) == 0)
      return option->get_envname() + fault.substr(name.size());
  }
  const std::vector<CLI::App*> commands = app.get_subcommands();
  return commands.empty() ? fault : with_source(*commands.front(), fault, words);
}

// The error, and the usage line of the command that was given.
std::string failure_text(const CLI::App& app, const CLI::Error& error, const Words& words) {
  const std::string help = app.help();
  const std::size_t begin = std::min(help.find("Usage:"), help.size());
  const std::string usage = help.substr(begin, help.find('\n', begin) - begin);
  return with_source(app, error.what(), words) + "\n" + usage + "\nRun with --help for more information.\n";
}

constexpr std::size_t kHelpColumn = 30;  // of descriptions

// The columns of the terminal; 100 if the help goes elsewhere.
std::size_t help_width() {
  winsize window{};
  if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &window) != 0 || window.ws_col == 0) return 100;
  return std::clamp<std::size_t>(window.ws_col, 60, 120);
}

// The text in lines of at most `width` characters, broken at spaces.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string out;
  std::size_t column = 0;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const bool fits = column + 1 + word.size() <= width;
    if (column > 0) out += fits ? ' ' : '\n';
    column = column > 0 && fits ? column + 1 + word.size() : word.size();
    out += word;
  }
  return out;
}

// CLI11 2.1 does not wrap descriptions.
class WrappedHelp final : public CLI::Formatter {
 public:
  WrappedHelp() { column_width(kHelpColumn); }
  std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(Formatter::make_option_desc(option), help_width() - kHelpColumn);
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream out;
    CLI::detail::format_help(out, command->get_name(),
                             wrapped(command->get_description(), help_width() - kHelpColumn), kHelpColumn);
    return out.str();
  }
};

// "a", "a or b", "a, b or c"
std::string choice_of(const std::vector<std::string>& texts) {
  std::string list;
  for (std::size_t i = 0; i < texts.size(); ++i)
    list += (i == 0 ? "" : i + 1 == texts.size() ? " or " : ", ") + texts[i];
  return list;
}

// CLI11's own checks accept "nan", and whole numbers too large for their type.
std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  if (!CLI::detail::lexical_cast(text, value) || !std::isfinite(value)) return std::nullopt;
  return value;
}

template <class Number>
std::optional<Number> whole_number(const std::string& text) {
  Number value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

template <class Number>
std::optional<Number> number_of(const std::string& text) {
  if constexpr (std::is_floating_point_v<Number>) {
    return finite_number(text);
  } else {
    return whole_number<Number>(text);
  }
}

std::vector<std::string> long_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* const option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> commands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* const command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

// The sentence about the first argument that a parsed command does not know; "" if there is none.
std::string unknown_argument(const CLI::App& program) {
  const CLI::App* app = &program;
  while (app->remaining().empty() && !app->get_subcommands().empty()) app = app->get_subcommands().back();
  const std::vector<std::string> rest = app->remaining();
  if (rest.empty()) return "";
  const std::string word = rest.front().substr(0, rest.front().find('='));
  const bool is_option = word.size() > 1 && word.front() == '-';
  const std::vector<std::string> commands = commands_of(*app);
  if (!is_option && commands.empty()) {
    return "Unexpected argument '" + word + "'.";
  }
  const std::string meant = io::did_you_mean(is_option ? long_options(*app) : commands, word);
  std::string sentence = std::string("Unknown ") + (is_option ? "option" : "command") + " '" + word + "'.";
  if (!meant.empty()) return sentence + meant;
  return is_option ? sentence : sentence + " Commands: " + io::joined(commands, ", ") + ".";
}

}  // namespace

Option& Option::required() {
  option_->required();
  return *this;
}
Option& Option::expected(int values) {
  option_->expected(values);
  return *this;
}
Option& Option::when_given(std::function<void()> action) {
  option_->each([action = std::move(action)](const std::string&) { action(); });
  return *this;
}
Option& Option::repeated() {
  option_->allow_extra_args(false);
  return *this;
}
Option& Option::show_default() {
  option_->capture_default_str();
  return *this;
}
Option& Option::show_default(const std::string& text) {
  option_->default_str(text);
  return *this;
}
Option& Option::type_name(const std::string& name) {
  option_->type_name(name);
  return *this;
}
Option& Option::environment(const std::string& variable) {
  option_->envname(variable);
  return *this;
}
Option& Option::hidden() {
  option_->group("");
  return *this;
}
Option& Option::excludes(Option other) {
  option_->excludes(other.option_);
  return *this;
}
Option& Option::needs(Option other) {
  option_->needs(other.option_);
  return *this;
}

template <class Number>
Option& Option::range(Number least, Number most) {
  return check(
      [least, most](const std::string& text) {
        const std::optional<Number> number = number_of<Number>(text);
        if (number && *number >= least && *number <= most) return std::string();
        return "is " + text + ", must be " + (std::is_integral_v<Number> ? "a whole number " : "") + "from " +
               CLI::detail::to_string(least) + " to " + CLI::detail::to_string(most);
      },
      CLI::Range(least, most).get_description());
}
Option& Option::whole() {
  return check(
      [](const std::string& text) {
        return whole_number<std::uint64_t>(text)
                   ? ""
                   : "is " + text + ", must be a whole number from 0 to 2^64 - 1";
      },
      "UINT");
}
template Option& Option::range(int, int);
template Option& Option::range(std::int64_t, std::int64_t);
template Option& Option::range(std::size_t, std::size_t);
template Option& Option::range(double, double);

Option& Option::finite() {
  return check(
      [](const std::string& text) {
        return finite_number(text) ? "" : "is " + text + ", must be a finite number";
      },
      "NUMBER");
}
Option& Option::positive() {
  return check(
      [](const std::string& text) {
        return finite_number(text).value_or(0.0) > 0.0 ? ""
                                                       : "is " + text + ", must be a finite number above 0";
      },
      "NUMBER > 0");
}
Option& Option::one_of(const std::vector<std::string>& texts) {
  return check(
      [texts](const std::string& text) {
        const bool is_one = std::find(texts.begin(), texts.end(), text) != texts.end();
        return is_one ? "" : "is " + text + ", must be " + choice_of(texts);
      },
      "{" + io::joined(texts, ",") + "}");
}
Option& Option::check(std::function<std::string(const std::string&)> fault_of,
                      const std::string& value_name) {
  option_->check(CLI::Validator(
      [fault_of = std::move(fault_of)](std::string& text) { return fault_of(text); }, value_name));
  return *this;
}

std::string Option::description() const { return option_->get_description(); }
void Option::describe(const std::string& description) { option_->description(description); }

CommandLine CommandLine::add_subcommand(const std::string& name, const std::string& description) const {
  return CommandLine(*app_->add_subcommand(name, description));
}
CommandLine CommandLine::subcommand(const std::string& name) const {
  return CommandLine(*app_->get_subcommand(name));
}
void CommandLine::require_subcommand(std::size_t least, std::size_t most) const {
  app_->require_subcommand(least, most);
}
void CommandLine::footer(const std::string& text) const { app_->footer(text); }
std::string CommandLine::footer() const { return app_->get_footer(); }

template <class Value>
Option CommandLine::add_option(const std::string& name, Value& value, const std::string& description) const {
  return Option(*app_->add_option(name, value, description));
}
#define SWIFTLET_OPTION_OF(...) \
  template Option CommandLine::add_option(const std::string&, __VA_ARGS__&, const std::string&) const
SWIFTLET_OPTION_OF(int);
SWIFTLET_OPTION_OF(unsigned);
SWIFTLET_OPTION_OF(std::int64_t);
SWIFTLET_OPTION_OF(std::uint64_t);
SWIFTLET_OPTION_OF(double);
SWIFTLET_OPTION_OF(std::string);
SWIFTLET_OPTION_OF(std::optional<int>);
SWIFTLET_OPTION_OF(std::optional<std::uint64_t>);
SWIFTLET_OPTION_OF(std::optional<double>);
SWIFTLET_OPTION_OF(std::array<double, 2>);
SWIFTLET_OPTION_OF(std::vector<int>);
SWIFTLET_OPTION_OF(std::vector<double>);
SWIFTLET_OPTION_OF(std::vector<std::string>);
#undef SWIFTLET_OPTION_OF

Option CommandLine::add_choice(const std::string& name, const std::vector<std::string>& choices,
                               const std::string& description,
                               std::function<void(std::size_t)> choose) const {
  CLI::Option* const option = app_->add_option_function<std::string>(
      name,
      [choices, choose = std::move(choose)](const std::string& chosen) {
        choose(static_cast<std::size_t>(std::find(choices.begin(), choices.end(), chosen) - choices.begin()));
      },
      description);
  return Option(*option).one_of(choices);
}
Option CommandLine::add_numbers(const std::string& name, int count,
                                std::function<void(const std::vector<double>&)> take,
                                const std::string& description) const {
  CLI::Option* const option =
      app_->add_option_function<std::vector<double>>(name, std::move(take), description);
  option->expected(count)->delimiter(',');
  return Option(*option).finite();
}
Option CommandLine::add_flag(const std::string& name, bool& value, const std::string& description) const {
  return Option(*app_->add_flag(name, value, description));
}
Option CommandLine::add_flag(const std::string& name, std::function<void()> is_set,
                             const std::string& description) const {
  return Option(*app_->add_flag_function(
      name, [is_set = std::move(is_set)](std::int64_t) { is_set(); }, description));
}
Option CommandLine::option(const std::string& name) const { return Option(*app_->get_option(name)); }
void CommandLine::remove_option(const std::string& name) const {
  app_->remove_option(app_->get_option(name));
}

std::string CommandLine::name() const { return app_->get_name(); }
std::string CommandLine::help() const { return app_->help(); }
bool CommandLine::parsed() const { return app_->parsed(); }

Program::Program(const std::string& name, const std::string& purpose)
    : app_(std::make_unique<CLI::App>(purpose, name)) {
  app_->formatter(std::make_shared<WrappedHelp>());
}
Program::~Program() = default;

void Program::add_version(const std::string& text) {
  app_->set_version_flag("--version", text, "Print the version and exit");
}

Program::Parsed Program::parse(int argc, const char* const* argv) {
  try {
    app_->parse(argc, argv);
    return Parsed::kRun;
  } catch (const CLI::ParseError& stop) {
    const std::string unknown = stop.get_exit_code() == 0 ? "" : unknown_argument(*app_);
    app_->failure_message([&](const CLI::App* app, const CLI::Error& error) {
      return failure_text(*app, error, {argv + 1, argv + argc});
    });
    if (unknown.empty()) return app_->exit(stop) == 0 ? Parsed::kHelp : Parsed::kWrongUsage;
    std::cerr << unknown << "\nRun with --help for more information.\n";
    return Parsed::kWrongUsage;
  }
}
Program::Parsed Program::parse(const std::string& line) {
  try {
    app_->parse(line);
    return Parsed::kRun;
  } catch (const CLI::ParseError& stop) {
    return stop.get_exit_code() == 0 ? Parsed::kHelp : Parsed::kWrongUsage;
  }
}

}  // namespace swiftlet::runtime

// Options and subcommands of a program's command line: a wrapper of CLI11 that is cheap to compile.
//
// CommandLine and Option are handles to CLI11's objects. They can be copied and are valid as long as the
// Program lives. An invalid definition, such as a duplicate name, throws CLI11's exception at start.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace swiftlet::runtime {

class Option {
 public:
  explicit Option(CLI::Option& option) : option_(&option) {}

  Option& required();
  Option& expected(int values);
  // Runs if the option is given, before the options are taken that were added after this one.
  Option& when_given(std::function<void()> action);
  Option& repeated();      // of a list: one value each time that it is given
  Option& show_default();  // in --help: the present value of the variable
  Option& show_default(const std::string& text);
  Option& type_name(const std::string& name);
  Option& environment(const std::string& variable);  // the value if the command line has none
  Option& hidden();                                  // not in --help
  Option& excludes(Option other);
  Option& needs(Option other);

  // Number is int, std::int64_t, std::size_t or double. The limits are valid values.
  template <class Number>
  Option& range(Number least, Number most);
  Option& whole();     // from 0 to 2^64 - 1
  Option& finite();    // neither infinite nor NaN
  Option& positive();  // finite and above 0
  Option& one_of(const std::vector<std::string>& texts);
  // fault_of returns why a text is refused, a sentence, or "" if it is valid. --help shows value_name.
  Option& check(std::function<std::string(const std::string&)> fault_of, const std::string& value_name);

  std::string description() const;
  void describe(const std::string& description);

 private:
  CLI::Option* option_;
};

class CommandLine {
 public:
  explicit CommandLine(CLI::App& app) : app_(&app) {}

  CommandLine add_subcommand(const std::string& name, const std::string& description) const;
  CommandLine subcommand(const std::string& name) const;  // one that was added
  void require_subcommand(std::size_t least, std::size_t most) const;
  void footer(const std::string& text) const;
  std::string footer() const;

  // name: "--name", "-n,--name", or "name" for a positional argument. `value` must outlive the parsing; its
  // content is the default. command_line.cpp lists the types for Value.
  template <class Value>
  Option add_option(const std::string& name, Value& value, const std::string& description) const;
  // An enumeration value, given by its name.
  template <class Value>
  Option add_choice(const std::string& name, Value& value, std::vector<std::pair<const char*, Value>> choices,
                    const std::string& description) const {
    std::vector<std::string> names;
    for (const auto& choice : choices) names.emplace_back(choice.first);
    return add_choice(name, names, description,
                      [choices, &value](std::size_t chosen) { value = choices[chosen].second; });
  }
  // So many finite numbers in one argument, between commas.
  Option add_numbers(const std::string& name, int count, std::function<void(const std::vector<double>&)> take,
                     const std::string& description) const;
  Option add_flag(const std::string& name, bool& value, const std::string& description) const;
  Option add_flag(const std::string& name, std::function<void()> is_set,
                  const std::string& description) const;
  Option option(const std::string& name) const;
  void remove_option(const std::string& name) const;

  std::string name() const;
  std::string help() const;
  bool parsed() const;  // true if this subcommand was given

  CLI::App& app() const { return *app_; }

 private:
  Option add_choice(const std::string& name, const std::vector<std::string>& choices,
                    const std::string& description, std::function<void(std::size_t)> choose) const;

  CLI::App* app_;
};

class Program {
 public:
  Program(const std::string& name, const std::string& purpose);
  ~Program();
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  CommandLine command_line() const { return CommandLine(*app_); }
  void add_version(const std::string& text);  // what --version prints

  enum class Parsed { kRun, kHelp, kWrongUsage };
  // Prints the help or version to stdout (kHelp), or the error and the usage line of the command to stderr (kWrongUsage).
  Parsed parse(int argc, const char* const* argv);
  // Parses one line without the program's name; prints nothing.
  Parsed parse(const std::string& line);

 private:
  std::unique_ptr<CLI::App> app_;
};

}  // namespace swiftlet::runtime

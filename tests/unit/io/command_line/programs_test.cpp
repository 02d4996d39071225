#include "swiftlet/io/command_line/programs.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "swiftlet/io/command_line/installation.hpp"
#include "swiftlet/io/program_directory.hpp"

namespace swiftlet::io::programs_test {

const char* program_of(const std::vector<const char*>& arguments) {
  const ProgramCommand* const command =
      program_command_of(static_cast<int>(arguments.size()), arguments.data());
  return command == nullptr ? "swiftlet" : command->program;
}

TEST(Programs, AreFoundByTheFirstWords) {
  EXPECT_STREQ(program_of({"swiftlet", "report", "flights"}), "swiftlet-analysis");
  EXPECT_STREQ(program_of({"swiftlet", "sim", "batch", "square"}), "swiftlet-analysis");
  EXPECT_STREQ(program_of({"swiftlet", "mocap", "list"}), "swiftlet-mocap-tool");
  EXPECT_STREQ(program_of({"swiftlet", "sim", "fly"}), "swiftlet");
  EXPECT_STREQ(program_of({"swiftlet", "sim"}), "swiftlet");
  EXPECT_STREQ(program_of({"swiftlet", "--help"}), "swiftlet");
  EXPECT_STREQ(program_of({"swiftlet"}), "swiftlet");
  EXPECT_STREQ(program_of({}), "swiftlet");
}

TEST(Programs, StandInTheHelpWithTheirPurpose) {
  runtime::Program program("swiftlet", "purpose");
  const runtime::CommandLine root = program.command_line();
  root.add_subcommand("sim", "group");
  root.add_subcommand("mission", "group");
  add_program_commands(root);
  EXPECT_NE(root.help().find(purpose_of("report")), std::string::npos) << root.help();
  EXPECT_NE(root.subcommand("sim").help().find("batch"), std::string::npos);
  EXPECT_THROW(purpose_of("fly"), std::logic_error);
}

TEST(Programs, CommandTextSurvivesJson) {
  runtime::Program program("swiftlet", "purpose");
  bool json = false;
  const runtime::CommandLine sub = program.command_line().add_subcommand("log", "logs");
  sub.add_flag("--json", json, "as JSON");
  sub.footer("example: \"quoted\"\nsecond line");
  const CommandText text = command_text(program.command_line());
  EXPECT_EQ(json_of(command_text_of_json(json_of(text))), json_of(text));
  EXPECT_EQ(bash_completion(command_text_of_json(json_of(text))), bash_completion(text));
  EXPECT_THROW(command_text_of_json("{\"words\": 1}"), std::runtime_error);
  EXPECT_THROW(command_text_of_json("no JSON"), std::runtime_error);
}

// GIVEN a package whose other one is not installed WHEN a program of that is asked for THEN the package is named.
TEST(Programs, OfAnotherPackageAreNamedWithIt) {
  set_program_directory("/usr/bin");
  std::string sentence;
  try {
    program_beside("swiftlet-analysis-not-here");
  } catch (const std::runtime_error& error) {
    sentence = error.what();
  }
  set_program_directory({});
  EXPECT_EQ(sentence,
            "swiftlet-analysis-not-here not found: the package swiftlet-analysis has it, "
            "apt install swiftlet-analysis");
}

TEST(Programs, QuotesWordsOfTheShell) { EXPECT_EQ(shell_quoted("it's a b"), "'it'\\''s a b'"); }

}  // namespace swiftlet::io::programs_test

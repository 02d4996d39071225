#include "swiftlet/services/runtime/command_line.hpp"

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace swiftlet::runtime::command_line_test {

class Numbers : public testing::Test {
 protected:
  Numbers() {
    const CommandLine app = program_.command_line();
    app.add_option("--seed", seed_, "").range(std::int64_t{0}, std::numeric_limits<std::int64_t>::max());
    app.add_option("--speed", speed_, "").range(0.01, 100.0);
    app.add_option("--id", id_, "").whole();
  }
  bool parses(const std::string& line) { return program_.parse(line) == Program::Parsed::kRun; }

  Program program_{"test", "a test"};
  std::uint64_t seed_ = 0;
  double speed_ = 0.0;
  std::uint64_t id_ = 0;
};

TEST_F(Numbers, AreRefusedIfTheyAreTooLarge) {
  EXPECT_TRUE(parses("--seed 9223372036854775807"));
  EXPECT_EQ(seed_, 9223372036854775807U);
  EXPECT_FALSE(parses("--seed 9223372036854775808"));
  EXPECT_FALSE(parses("--seed 100000000000000000000000"));
  EXPECT_FALSE(parses("--seed -1"));
  EXPECT_FALSE(parses("--seed 1.5"));
  EXPECT_FALSE(parses("--seed 1e3"));
  EXPECT_TRUE(parses("--id 18446744073709551615"));
  EXPECT_EQ(id_, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(parses("--id 100000000000000000000000"));
  EXPECT_FALSE(parses("--id -1"));
}

TEST_F(Numbers, AreRefusedIfTheyAreNotFinite) {
  EXPECT_TRUE(parses("--speed 0.5"));
  for (const char* speed : {"nan", "-nan", "inf", "1e999", "0", "101", "fast"})
    EXPECT_FALSE(parses(std::string("--speed ") + speed)) << speed;
}

class Words : public testing::Test {
 protected:
  Words() {
    const CommandLine root = program_.command_line();
    root.require_subcommand(0, 1);
    const CommandLine fly = root.add_subcommand("fly", "");
    fly.add_option("mission", text_, "");
    fly.add_option("--vehicle", text_, "");
    fly.add_choice<int>("--clock", clock_, {{"realtime", 0}, {"lockstep", 1}}, "");
    fly.add_option("--colour", text_, "").one_of({"red", "green", "blue"});
    const CommandLine go = root.add_subcommand("goto", "");
    go.add_option("x", text_, "").required();
    go.add_option("--speed", text_, "");
    const CommandLine mission = root.add_subcommand("mission", "");
    mission.require_subcommand(1, 1);
    mission.add_subcommand("upload", "");
  }
  std::string message(std::vector<const char*> words) {
    words.insert(words.begin(), "test");
    testing::internal::CaptureStderr();
    const Program::Parsed parsed = program_.parse(static_cast<int>(words.size()), words.data());
    const std::string text = testing::internal::GetCapturedStderr();
    return parsed == Program::Parsed::kRun ? "run" : text.substr(0, text.find('\n'));
  }

  Program program_{"test", "a test"};
  std::string text_;
  int clock_ = 0;
};

TEST_F(Words, ThatAreUnknownGetTheNearestName) {
  EXPECT_EQ(message({"fly", "square", "--vehicle", "kaylion"}), "run");
  EXPECT_EQ(message({"flyy", "square"}), "Unknown command 'flyy'. Did you mean 'fly'?");
  EXPECT_EQ(message({"dance"}), "Unknown command 'dance'. Commands: fly, goto, mission.");
  EXPECT_EQ(message({"mission", "uplaod"}), "Unknown command 'uplaod'. Did you mean 'upload'?");
  EXPECT_EQ(message({"fly", "--vehcle", "kaylion"}), "Unknown option '--vehcle'. Did you mean '--vehicle'?");
  EXPECT_EQ(message({"fly", "--vehcle=kaylion"}), "Unknown option '--vehcle'. Did you mean '--vehicle'?");
  EXPECT_EQ(message({"fly", "--zzz"}), "Unknown option '--zzz'.");
  EXPECT_EQ(message({"fly", "square", "circle"}), "Unexpected argument 'circle'.");
}

TEST_F(Words, ThatAreNoChoiceGetTheChoices) {
  EXPECT_EQ(message({"fly", "--clock", "lockstep"}), "run");
  EXPECT_EQ(message({"fly", "--clock", "sundial"}), "--clock: is sundial, must be realtime or lockstep");
  EXPECT_EQ(message({"fly", "--colour", "pink"}), "--colour: is pink, must be red, green or blue");
}

TEST_F(Words, ThatAreUnknownAreNamedBeforeThoseThatAreMissing) {
  EXPECT_EQ(message({"goto", "--sped"}), "Unknown option '--sped'. Did you mean '--speed'?");
  EXPECT_EQ(message({"goto"}), "x is required");
}

// What a program prints whose command `list` takes --domain, or its variable.
std::string printed(std::vector<const char*> words) {
  int domain = 0;
  Program program("test", "a test");
  const CommandLine list = program.command_line().add_subcommand("list", "a command");
  list.add_option("--domain", domain, "").environment("SWIFTLET_TEST_DOMAIN").range(0, 232);
  words.insert(words.begin(), "test");
  testing::internal::CaptureStderr();
  EXPECT_EQ(program.parse(static_cast<int>(words.size()), words.data()), Program::Parsed::kWrongUsage);
  const std::string text = testing::internal::GetCapturedStderr();
  return text.substr(0, text.find('\n'));
}

TEST(Environment, IsBlamedForItsValuesOnly) {
  setenv("SWIFTLET_TEST_DOMAIN", "9999", 1);
  EXPECT_EQ(printed({"list"}), "SWIFTLET_TEST_DOMAIN: is 9999, must be a whole number from 0 to 232");
  for (const std::vector<const char*>& given :
       {std::vector{"list", "--domain", "9999"}, {"list", "--domain=9999"}})
    EXPECT_EQ(printed(given), "--domain: is 9999, must be a whole number from 0 to 232");
  unsetenv("SWIFTLET_TEST_DOMAIN");
}

TEST(Help, WrapsDescriptions) {
  Program program("test", "a test");
  std::string text;
  std::string description = "begin";
  for (int i = 0; i < 40; ++i) description += " word" + std::to_string(i);
  program.command_line().add_option("--text", text, description);
  program.command_line().add_subcommand("fly", description);
  std::istringstream lines(program.command_line().help());
  int wrapped = 0;
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120U) << line;
    wrapped += line.rfind(std::string(30, ' ') + "word", 0) == 0 ? 1 : 0;
  }
  EXPECT_GE(wrapped, 4) << program.command_line().help();
}

}  // namespace swiftlet::runtime::command_line_test

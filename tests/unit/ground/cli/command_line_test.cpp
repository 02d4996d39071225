#include <CLI/CLI.hpp>
#include <gtest/gtest.h>

#include "swiftlet/ground/cli/commands.hpp"

namespace swiftlet::ground::command_line_test {

class CommandLine : public testing::Test {
 protected:
  CommandLine() {
    app_.require_subcommand(1);
    const runtime::CommandLine root(app_);
    commands_ = {add_fly_command(root),     add_arm_command(root),  add_disarm_command(root),
                 add_takeoff_command(root), add_goto_command(root), add_land_command(root),
                 add_hold_command(root),    add_stop_command(root), add_mission_command(root),
                 add_status_command(root),  add_gains_command(root)};
  }

  bool parses(const std::string& line) {
    try {
      app_.parse(line);
      return true;
    } catch (const CLI::ParseError&) {
      return false;
    }
  }
  double value(const std::string& command, const std::string& option) {
    return app_.get_subcommand(command)->get_option(option)->as<double>();
  }

  CLI::App app_;
  std::vector<io::Command> commands_;
};

TEST_F(CommandLine, GotoAcceptsNegativeNumbers) {
  ASSERT_TRUE(parses("goto -1 0 -1.5"));
  EXPECT_EQ(value("goto", "x"), -1.0);
  EXPECT_EQ(value("goto", "y"), 0.0);
  EXPECT_EQ(value("goto", "z"), -1.5);
}

TEST_F(CommandLine, GotoAcceptsNegativeNumbersWithExponents) {
  ASSERT_TRUE(parses("goto -0.5 -1e-1 -1 --yaw -1.57 --speed 0.2"));
  EXPECT_EQ(value("goto", "x"), -0.5);
  EXPECT_EQ(value("goto", "y"), -0.1);
  EXPECT_EQ(value("goto", "--yaw"), -1.57);
}

TEST_F(CommandLine, GotoRefusesInvalidPositions) {
  EXPECT_FALSE(parses("goto 1"));
  EXPECT_FALSE(parses("goto 1 2 up"));
  EXPECT_FALSE(parses("goto 1 2 -1 --height 1"));
  EXPECT_FALSE(parses("goto 1 2 --height -1"));
  EXPECT_FALSE(parses("goto 1 2 -1 4"));
  EXPECT_FALSE(parses("goto nan 2 -1"));
  EXPECT_FALSE(parses("goto 1 2 -1 --yaw inf"));
  EXPECT_FALSE(parses("goto 1 2 -1 --speed 0"));
}

TEST_F(CommandLine, HeightIsAnotherWordForZ) {
  ASSERT_TRUE(parses("goto -1 0 --height 1.5"));
  EXPECT_EQ(value("goto", "--height"), 1.5);
  ASSERT_TRUE(parses("takeoff --height 1.2"));
  EXPECT_EQ(value("takeoff", "--height"), 1.2);
  EXPECT_FALSE(parses("takeoff 1 --height 1"));
}

TEST_F(CommandLine, FlyAttachesOrStartsProcesses) {
  EXPECT_TRUE(parses("fly square --attach"));
  EXPECT_TRUE(parses("fly square --attach --localhost-only"));
  EXPECT_FALSE(parses("fly square --attach --seed 2"));
  EXPECT_FALSE(parses("fly square --attach --vehicle other.yaml"));
}

TEST_F(CommandLine, TakeoffRequiresAPositiveHeight) {
  EXPECT_TRUE(parses("takeoff"));
  EXPECT_TRUE(parses("takeoff 1.5"));
  EXPECT_FALSE(parses("takeoff -1"));
  EXPECT_FALSE(parses("takeoff 0"));
  EXPECT_FALSE(parses("takeoff inf"));
}

TEST_F(CommandLine, FlyAcceptsSupportedRates) {
  EXPECT_TRUE(parses("fly square --imu-rate 1000"));
  EXPECT_TRUE(parses("fly square --imu-rate 500 --seed 3 --domain 232 --json --clock lockstep"));
  EXPECT_FALSE(parses("fly square --imu-rate 800"));
  EXPECT_TRUE(parses("fly"));
  EXPECT_FALSE(parses("fly square --seed -1"));
  EXPECT_FALSE(parses("fly square --clock sundial"));
}

TEST_F(CommandLine, RefusesInvalidDomainsAndVehicleNames) {
  EXPECT_FALSE(parses("status --domain 233"));
  EXPECT_FALSE(parses("status --domain -1"));
  EXPECT_FALSE(parses("status --vehicle-name kl/1"));
  EXPECT_FALSE(parses("status --vehicle-name ''"));
  EXPECT_FALSE(parses("status --timeout 0"));
  EXPECT_TRUE(parses("status --domain 232 --vehicle-name kl_2"));
}

TEST_F(CommandLine, EveryCommandShowsAnExample) {
  for (const io::Command& command : commands_) {
    EXPECT_NE(command.app.help().find("example: swiftlet " + command.app.name()), std::string::npos)
        << command.app.name();
  }
}

TEST_F(CommandLine, RefusesUnknownWords) {
  EXPECT_FALSE(parses("loop"));
  EXPECT_FALSE(parses("arm now"));
  EXPECT_FALSE(parses("arm --force"));
  EXPECT_FALSE(parses(""));
}

}  // namespace swiftlet::ground::command_line_test

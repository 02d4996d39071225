// Invalid input ends with exit code 2 and a message, before any process starts or vehicle moves.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "tests/support/paths.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"

namespace swiftlet::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

const std::string kMission =
    "frame: ned\ntolerance_m: 0.1\nitems:\n"
    "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [1, 0, -1], speed_m_s: 0.5}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class BadInput : public testing::Test {
 protected:
  fs::path record() const { return folder_.path() / "record"; }

  // Runs `swiftlet fly` with these arguments. Expects a refusal with the sentence and no process started.
  void expect_refusal(std::vector<std::string> words, const std::string& sentence) const {
    words.insert(words.begin(), "fly");
    words.insert(words.end(), {"--json", "--record", record().string()});
    const ProgramResult result = run_program("swiftlet", words, folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
    EXPECT_EQ(result.output, "");
    EXPECT_FALSE(fs::exists(record())) << "logs exist, so processes were started";
  }

  TemporaryFolder folder_;
};

TEST_F(BadInput, MissionOutsideTheFence) {
  const std::string file = folder_.write("far.yaml", replaced(kMission, "[1, 0, -1]", "[1, 40, -1]"));
  expect_refusal({file}, file + ":5: items[1].position_m: east is 40 m, must be inside the fence, -3 to 3 m");
}

TEST_F(BadInput, SeveralVehicles) {
  const std::string file = folder_.write("mission.yaml", kMission);
  expect_refusal({file, "--vehicle-name", "kl1,kl1"}, "names kl1 twice");
  expect_refusal({file, "--vehicle-name", "kl1,,kl2"}, "each name must be 1 to 64 letters, digits and _");
  expect_refusal({file + "," + file, "--vehicle-name", "a,b,c"},
                 "2 missions but 3 vehicles; give one for all, or one for each");
  expect_refusal({file + "," + file}, "2 missions but 1 vehicle; add --vehicle-name kl1,kl2");
  expect_refusal({file + "," + file + "," + file, "--vehicle-name", "kl2,a"},
                 "3 missions but 2 vehicles; add --vehicle-name kl2,a,kl1");
  expect_refusal({file, "--vehicle-name", "kl1..kl51"}, "names 51 vehicles, limit 50 per command");
  expect_refusal({file, "--vehicle-name", "a,b", "--spacing", "40"},
                 "mission.yaml: started at 0 m north and -20 m east of the origin: item 2: y is -20.000 m");
  expect_refusal({file, "--vehicle-name", "kl1,2nd"}, "begin with a letter and have no __");
  expect_refusal({file, "--vehicle-name", "kl__1"}, "begin with a letter and have no __");
  expect_refusal({file, "--vehicle-name", "a,b", "--spacing", "0"},
                 "--spacing: 0 m puts the vehicles inside each other: a kaylion is up to 0.24 m wide");
  const ProgramResult goto_result =
      run_program("swiftlet", {"goto", "0", "0", "-1", "--vehicle-name", "kl1,kl2"}, folder_.path());
  EXPECT_EQ(goto_result.exit_code, 2);
  EXPECT_NE(goto_result.errors.find("must be 1 to 64 letters, digits and _"), std::string::npos)
      << goto_result.errors;
}

TEST_F(BadInput, UnknownNames) {
  expect_refusal(
      {"squre"},
      "No mission 'squre'. Did you mean 'square'? Available: calibration, identification, square, tour");
  expect_refusal({"square", "--vehicle", "kaylon"}, "No vehicle 'kaylon'. Did you mean 'kaylion'?");
  expect_refusal({"square", "--control", "papr"}, "No control settings 'papr'. Did you mean 'paper'?");
  const std::string file = folder_.write("kind.yaml", replaced(kMission, "waypoint", "waypont"));
  expect_refusal({file}, "items[1].kind: is waypont, must be takeoff, waypoint");
}

TEST_F(BadInput, MissionBelowTheMinimumHeight) {
  const std::string below = folder_.write("below.yaml", replaced(kMission, "[1, 0, -1]", "[1, 0, 1]"));
  expect_refusal({below},
                 below +
                     ":5: items[1].position_m: in NED: z = +1.000 m is below the ground, as z points down "
                     "(NED); 1.000 m above the ground is z = -1.000 m");
  const std::string low = folder_.write("low.yaml", replaced(kMission, "height_m: 1", "height_m: 0.05"));
  expect_refusal({low}, low + ":4: items[0].height_m: is 0.05 m, must be at least the minimum height, 0.1 m");
}

TEST_F(BadInput, MissingMission) { expect_refusal({"nowhere.yaml"}, "nowhere.yaml: is not found"); }

TEST_F(BadInput, TruncatedMission) {
  expect_refusal({folder_.write("cut.yaml", kMission.substr(0, kMission.size() - 20))}, "cut.yaml:6:");
}

TEST_F(BadInput, MissionWithoutATakeoff) {
  const std::string file =
      folder_.write("low.yaml", replaced(kMission, "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n", ""));
  expect_refusal({file}, file + ": items: the first item is not a takeoff");
}

TEST_F(BadInput, MissionWithoutALanding) {
  const std::string file =
      folder_.write("up.yaml", replaced(kMission, "  - {kind: land, speed_m_s: 0.5}\n", ""));
  expect_refusal({file}, file + ":5: items[1]: is the last item, which must be a land");
}

TEST_F(BadInput, MissionThatTheVehicleCannotFly) {
  const std::string mass = "mass: {value: ";
  std::string vehicle = text_of(in_source("config/vehicles/kaylion.yaml"));
  const std::size_t at = vehicle.find(mass) + mass.size();
  vehicle.replace(at, vehicle.find(',', at) - at, "0.066");
  const std::string file = folder_.write("m.yaml", kMission);
  expect_refusal({file, "--vehicle", folder_.write("heavy.yaml", vehicle)}, "cannot fly it: item ");
}

TEST_F(BadInput, InvalidVehicle) {
  const std::string vehicle = text_of(in_source("config/vehicles/kaylion.yaml"));
  const std::string key = "mass: {value: ";
  ASSERT_NE(vehicle.find(key), std::string::npos);
  const std::string file = folder_.write("heavy.yaml", replaced(vehicle, key, key + "-"));
  expect_refusal({"square", "--vehicle", file}, "heavy.yaml:");
}

TEST_F(BadInput, ControlSettingsWithAnUnknownKey) {
  const std::string settings = text_of(in_source("config/control/motor_lag.yaml"));
  const std::string file = folder_.write("odd.yaml", settings + "thrust: 3\n");
  expect_refusal({"square", "--control", file}, "odd.yaml:");
}

TEST_F(BadInput, MissingSimulation) {
  expect_refusal({"square", "--simulation", "moon"}, "No simulation settings 'moon'. Available: ");
}

TEST_F(BadInput, WrongUsage) {
  expect_refusal({"square", "--imu-rate", "777"}, "--imu-rate");
  expect_refusal({"square", "--domain", "500"}, "--domain");
  expect_refusal({"square", "--vehicle-name", "a b"}, "--vehicle-name");
  expect_refusal({"square", "--seed", "-1"},
                 "--seed: is -1, must be a whole number from 0 to 9223372036854775807");
  expect_refusal({"square", "--seed", "100000000000000000000000"},
                 "--seed: is 100000000000000000000000, must be a whole number from 0 to");
  expect_refusal({"square", "--speed", "nan"}, "--speed: is nan, must be from 0.01 to 100");
  expect_refusal({"square", "--clock", "sundial"}, "--clock: is sundial, must be realtime or lockstep");
}

TEST_F(BadInput, NameOfAVehicle) {
  for (const char* program : {"swiftlet-plant", "swiftlet-mocap", "swiftlet-control"}) {
    const ProgramResult result = run_program(program, {"--vehicle-name", "a b"}, folder_.path());
    EXPECT_EQ(result.exit_code, 2) << program;
    EXPECT_NE(result.errors.find("--vehicle-name: must be 1 to 64 letters, digits and _"), std::string::npos)
        << result.errors;
  }
}

TEST_F(BadInput, RecordFolderThatCannotBeCreated) {
  const std::string file = folder_.write("file", "");
  const ProgramResult result =
      run_program("swiftlet", {"fly", "square", "--record", file + "/record"}, folder_.path());
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.errors.find("the folder cannot be created"), std::string::npos) << result.errors;
}

TEST_F(BadInput, OnlineCommands) {
  const auto refuses = [&](std::vector<std::string> words, const std::string& sentence) {
    const ProgramResult result = run_program("swiftlet", std::move(words), folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    EXPECT_NE(result.errors.find(sentence), std::string::npos) << result.errors;
  };
  refuses({"goto", "1"}, "y is required\nUsage: swiftlet goto [OPTIONS] x y [z]\n");
  refuses({"mission", "upload"}, "file is required\nUsage: swiftlet mission upload [OPTIONS] file\n");
  refuses({"goto", "1", "2"}, "goto: needs either z (down: negative is up) or --height");
  refuses({"goto", "1", "0", "0.1"}, "goto: z = +0.100 m is below the ground, as z points down (NED)");
  refuses({"goto", "1", "0", "-1", "--yaw", "90"},
          "goto: yaw is 90 rad, more than a full turn: 90 degrees are");
  refuses({"goto", "1", "0", "--heigth", "1"}, "Unknown option '--heigth'. Did you mean '--height'?");
  refuses(
      {"stream", folder_.write("low.csv", "t [s],x_ned [m],y_ned [m],z_ned [m]\n0,0,0,-1\n0.1,0,0,0.2\n")},
      "low.csv:3: z: in NED: z = +0.200 m is below the ground");
  refuses({"stream", folder_.write("odd.csv", "t,x\x1b[31m\n")}, "odd.csv:1: is not a text file");
  refuses({"goto", "1", "2", "nan"}, "is nan, must be a finite number");
  refuses({"takeoff", "-1"}, "must be a finite number above 0");
  refuses({"land", "--speed", "0"}, "must be a finite number above 0");
  refuses({"mission", "check", folder_.write("far.yaml", replaced(kMission, "[1, 0, -1]", "[1, 40, -1]"))},
          "east is 40 m");
  refuses({"teleop"}, "teleop: requires a terminal, or --joystick DEVICE");
  const std::string text = folder_.write("event3", "");
  refuses({"teleop", "--joystick", text}, text + " is not an event device; they are /dev/input/event*");
  refuses({"teleop", "--joystick", text + "x"}, "cannot open " + text + "x: No such file or directory");
  refuses({"circle"}, "Unknown command 'circle'. Commands: fly, arm");
  refuses({"gains", "--seed", "100000000000000000000000"}, "must be a whole number from 0 to 2^64 - 1");
  refuses({"flyy"}, "Unknown command 'flyy'. Did you mean 'fly'?");
  refuses({}, "swiftlet: a command is required");
}

TEST_F(BadInput, HelpIsNotRefused) {
  for (const char* command :
       {"fly", "arm", "disarm", "takeoff", "goto", "land", "hold", "stop", "mission", "trajectory", "stream",
        "teleop", "status", "watch", "list", "gains", "identify"}) {
    const ProgramResult result = run_program("swiftlet", {command, "--help"}, folder_.path());
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.output.find("example: swiftlet " + std::string(command)), std::string::npos)
        << result.output;
  }
}

}  // namespace
}  // namespace swiftlet::tests

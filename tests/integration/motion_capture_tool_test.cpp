// The commands of motion capture, and the options of swiftlet-mocap.
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/mocap/room.hpp"
#include "tests/integration/filmed_body.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/mocap/natnet_server.hpp"
#include "tests/support/program.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using namespace filmed_body;
using nlohmann::json;

// GIVEN a body that sits askew, of a vehicle that stands and then is turned about its centre THEN the room file says how.
TEST(MotionCaptureTool, CalibratesABodyAndListsIt) {
  const TemporaryFolder folder;
  NatNetServer server({});
  server.set_models({{"drone", kBody}});
  const std::string room = (folder.path() / "room.yaml").string();
  std::ofstream(room) << "source: natnet\nserver: " << server.name()
                      << "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n"
                      << "  kl1: {body: drone, lever_arm_frd_m: [0, 0, 0], misalignment_rad: [0, 0, 0]}\n";
  std::int32_t number = 0;
  const auto send = [&](const Quaterniond& attitude) {
    const PoseSample vehicle{0, 0, true, {1.0, 2.0, -0.5}, attitude};
    server.send(frame_of({"drone", kBody}, ++number, with_y_up(body_of(vehicle))));
  };
  Program calibrate(
      "swiftlet",
      {"mocap", "calibrate", "kl1", "--room", room, "--no-prompt", "--rest-time", "1", "--turn-time", "2"},
      folder.path());
  double turned = 0.0;
  ASSERT_TRUE(eventually(
      [&] {
        const bool turns = calibrate.errors().find("Hold its centre of mass") != std::string::npos;
        if (turns) turned += 0.02;
        const Vector3d angles(0.6 * std::sin(3 * turned), 0.6 * std::sin(4 * turned),
                              0.5 * std::sin(5 * turned));
        const double angle = angles.norm();
        send(angle < 1e-9 ? Quaterniond::Identity() : Quaterniond(Eigen::AngleAxisd(angle, angles / angle)));
        return calibrate.exit_code().has_value();
      },
      kStuck, std::chrono::milliseconds(5)));
  EXPECT_EQ(calibrate.exit_code(), 0) << calibrate.errors();
  const mocap::Room written = mocap::load_room(room);
  EXPECT_LT((mocap::find(written, "kl1")->lever_arm_frd - kLeverArm).norm(), 1e-4) << calibrate.output();
  EXPECT_LT((mocap::find(written, "kl1")->misalignment - kMisalignment).norm(), 1e-4) << calibrate.output();

  Program list("swiftlet", {"mocap", "list", "--room", room, "--json", "--time", "1"}, folder.path());
  ASSERT_TRUE(eventually(
      [&] {
        send(Quaterniond::Identity());
        return list.exit_code().has_value();
      },
      kStuck, std::chrono::milliseconds(5)));
  EXPECT_EQ(list.exit_code(), 0) << list.errors();
  const json listed = json::parse(list.output());
  ASSERT_EQ(listed.at("bodies").size(), 1U);
  EXPECT_EQ(listed.at("bodies")[0].at("body"), "drone");
  EXPECT_EQ(listed.at("bodies")[0].at("id"), kBody);
  EXPECT_EQ(listed.at("bodies")[0].at("tracked"), true);
  EXPECT_GT(listed.at("bodies")[0].at("rate_hz").get<double>(), 10.0);
}

// GIVEN a motion capture that sends nothing WHEN Ctrl-C is pressed THEN the commands that wait end.
TEST(MotionCaptureTool, EndsWhenItIsInterrupted) {
  const TemporaryFolder folder;
  const std::string room = (folder.path() / "room.yaml").string();
  std::ofstream(room) << "source: vrpn\nserver: 127.0.0.1:9\nframe: zup\nvehicles:\n"
                      << "  kl1: {body: kl1, lever_arm_frd_m: [0, 0, 0], misalignment_rad: [0, 0, 0]}\n";
  const struct {
    std::vector<std::string> words;
    std::string ready;  // what it shows when it waits
  } cases[] = {{{"watch", "--period", "0.1"}, "0 frames"}, {{"calibrate", "--no-prompt"}, "level ground"}};
  for (const auto& one : cases) {
    SCOPED_TRACE(one.words.front());
    std::vector<std::string> words = {"mocap"};
    words.insert(words.end(), one.words.begin(), one.words.end());
    words.insert(words.end(), {"--room", room});
    Program tool("swiftlet", words, folder.path());
    ASSERT_TRUE(eventually([&] {
      return (tool.output() + tool.errors()).find(one.ready) != std::string::npos;
    })) << tool.errors();
    tool.signal(SIGINT);
    EXPECT_EQ(tool.wait(kStuck), 1) << tool.errors();
  }
  Terminal at_the_prompt("swiftlet", {"mocap", "calibrate", "--room", room}, 120, 40);
  ASSERT_TRUE(eventually([&] { return at_the_prompt.text().find("press Enter") != std::string::npos; }));
  at_the_prompt.type("\x03");
  EXPECT_EQ(at_the_prompt.wait(kStuck), 1) << at_the_prompt.text();
}

class MotionCaptureOptions : public testing::Test {
 protected:
  std::string refusal(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run_program("swiftlet-mocap", arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    return result.errors;
  }
  TemporaryFolder folder_;
};

TEST_F(MotionCaptureOptions, ThatDoNotGoTogetherAreRefused) {
  const struct {
    std::vector<std::string> arguments;
    std::string sentence;
  } cases[] = {
      {{"--server", "lab1"}, "--server: not with --source simulation"},
      {{"--source", "natnet"},
       "--frame is required without --room: zup or yup, as the motion capture is set"},
      {{"--source", "natnet", "--frame", "zup", "--clock", "lockstep"},
       "--clock lockstep: only with --source simulation"},
      {{"--source", "natnet", "--frame", "zup", "--frame-clock", "host"},
       "--frame-clock host: only with --source simulation"},
      {{"--source", "vrpn", "--frame", "zup"}, "--source vrpn needs --server"},
      {{"--source", "replay", "--frame", "zup"}, "--source replay needs --file"},
      {{"--source", "vrpn", "--frame", "zup", "--server", "127.0.0.1:99999"},
       "server: is '127.0.0.1:99999', must be"},
      {{"--source", "vicon", "--frame", "zup", "--mocap-interface", "eth99"},
       "interface: is 'eth99', must be"},
      {{"--room", "optitrack", "--vehicle-name", "kl9"}, "vehicles: does not have the vehicle kl9"},
  };
  for (const auto& one : cases) {
    const std::string sentence = refusal(one.arguments);
    EXPECT_NE(sentence.find(one.sentence), std::string::npos) << sentence;
  }
}

}  // namespace
}  // namespace swiftlet::tests

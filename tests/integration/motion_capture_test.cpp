// Flies through real motion capture protocols: a scripted server sends what the plant's ground truth says, as cameras would
// see it, and swiftlet-mocap brings it to control.
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/hop_mission.hpp"
#include "tests/support/natnet_server.hpp"
#include "tests/support/separate_processes.hpp"
#include "tests/support/vrpn_server.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using nlohmann::json;

constexpr std::uint64_t kTruthPerFrame = 5;  // 100 frames per second
constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr std::int32_t kBody = 42;

const Vector3d kLeverArm(0.01, -0.02, 0.03);
const Vector3d kMisalignment(0.0, 0.0, 0.35);  // rad
const std::string kBodyKeys = "lever_arm_frd_m: [0.01, -0.02, 0.03], misalignment_rad: [0, 0, 0.35]";

struct Pose {
  Vector3d position;
  Quaterniond attitude;
};

// The pose of the body that is fixed to the vehicle like this.
Pose body_of(const comms::msg::GroundTruth& truth) {
  const auto& p = truth.position_ned();
  const auto& q = truth.q_ned_from_frd();
  const Quaterniond vehicle(q[0], q[1], q[2], q[3]);
  const Quaterniond turn(Eigen::AngleAxisd(kMisalignment.norm(), kMisalignment.normalized()));
  return {Vector3d(p[0], p[1], p[2]) - vehicle * kLeverArm, vehicle * turn.conjugate()};
}

// Forward, up, right; forward, left, up.
Pose with_y_up(const Pose& ned) {
  const auto turned = [](const Vector3d& v) { return Vector3d(v.x(), -v.z(), v.y()); };
  Pose pose{turned(ned.position), Quaterniond(ned.attitude.w(), 0, 0, 0)};
  pose.attitude.vec() = turned(ned.attitude.vec());
  return pose;
}
Pose with_z_up(const Pose& ned) {
  const auto turned = [](const Vector3d& v) { return Vector3d(v.x(), -v.y(), -v.z()); };
  Pose pose{turned(ned.position), Quaterniond(ned.attitude.w(), 0, 0, 0)};
  pose.attitude.vec() = turned(ned.attitude.vec());
  return pose;
}

class MotionCapture : public SeparateProcesses {
 protected:
  // Calls `show` with each fifth ground truth.
  void film(std::function<void(const comms::msg::GroundTruth&)> show) {
    cameras_ = watcher_->subscribe<comms::msg::GroundTruth>(comms::topics::kGroundTruth, [show](const auto& truth) {
      if (truth.sequence_number() % kTruthPerFrame == 0) show(truth);
    });
  }
  // Starts all processes with this room, and waits until control has poses.
  void start_with(const std::string& room) {
    const std::string file = (folder_.path() / "room.yaml").string();
    std::ofstream(file) << room;
    control_ = start("swiftlet-control");
    plant_ = start("swiftlet-plant");
    mocap_ = start("swiftlet-mocap", {"--room", file});
    wait_until_ready();
  }
  // The tracking error of a mission, which is that of the real pose.
  double flown_rms_m(const std::string& mission) {
    const ProgramResult result =
        run_program("swiftlet",
                    {"fly", mission, "--attach", "--localhost-only", "--domain", std::to_string(lock_.domain()), "--json",
                     "--record", (folder_.path() / "record").string()},
                    folder_.path(), kStuck);
    EXPECT_EQ(result.exit_code, 0) << result.errors << mocap_->errors() << control_->errors();
    return result.exit_code == 0 ? json::parse(result.output).at("rms_3d_m").get<double>() : 1e9;
  }
  std::string hop() const {
    const std::string file = (folder_.path() / "hop.yaml").string();
    std::ofstream(file) << kHopMission;
    return file;
  }

  comms::Subscription cameras_;
};

// GIVEN a server of NatNet 4.1 with y up, an hour ahead, whose body is turned by 20 degrees and 4 cm off THEN the square is
// flown as closely as with the simulated motion capture.
TEST_F(MotionCapture, FliesTheSquareThroughNatNet) {
  NatNetServer::Settings settings;
  settings.clock_offset_ns = kHourNs;
  NatNetServer server(settings);
  server.set_models({{"drone", kBody}});
  film([&server, number = 0](const auto& truth) mutable {
    const Pose pose = with_y_up(body_of(truth));
    natnet::Frame frame;
    frame.number = ++number;
    frame.with_others = false;
    natnet::Body body{"drone", kBody};
    for (int i = 0; i < 3; ++i) body.position[i] = static_cast<float>(pose.position[i]);
    for (int i = 0; i < 4; ++i) body.q_xyzw[i] = static_cast<float>(pose.attitude.coeffs()[i]);
    frame.bodies = {body};
    server.send(frame);
  });
  start_with("source: natnet\nserver: " + server.name() + "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n  kl1: {body: drone, " +
             kBodyKeys + "}\n");
  const double rms_m = flown_rms_m("square");
  RecordProperty("rms_3d_mm", static_cast<int>(std::lround(1e3 * rms_m)));
  EXPECT_LT(rms_m, 0.005);
  mocap_->signal(SIGTERM);
  EXPECT_EQ(mocap_->wait(kStuck), 0) << mocap_->errors();
  EXPECT_NE(mocap_->errors().find("kl1 is body 'drone' with number 42"), std::string::npos) << mocap_->errors();
}

TEST_F(MotionCapture, FliesThroughVrpn) {
  VrpnServer::Settings settings;
  settings.trackers = {"other", "drone"};
  settings.clock_offset_ns = -kHourNs;
  VrpnServer server(settings);
  film([&server](const auto& truth) {
    const Pose pose = with_z_up(body_of(truth));
    const Vector3d& p = pose.position;
    const Eigen::Vector4d q = pose.attitude.coeffs();
    server.send(1, {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]});
  });
  start_with("source: vrpn\nserver: " + server.name() + "\nframe: zup\nvehicles:\n  kl1: {body: drone, " + kBodyKeys + "}\n");
  EXPECT_LT(flown_rms_m(hop()), 0.01);
}

// GIVEN a body that is lost in flight THEN control hears so at once, and the vehicle lands as it does without poses.
TEST_F(MotionCapture, ReportsABodyThatIsLost) {
  NatNetServer server({});
  server.set_models({{"kl1", kBody}});
  std::atomic<bool> tracked{true};
  film([&, number = 0](const auto& truth) mutable {
    const Pose pose = with_y_up(body_of(truth));
    natnet::Frame frame;
    frame.number = ++number;
    natnet::Body body{"kl1", kBody};
    for (int i = 0; i < 3; ++i) body.position[i] = static_cast<float>(pose.position[i]);
    for (int i = 0; i < 4; ++i) body.q_xyzw[i] = static_cast<float>(pose.attitude.coeffs()[i]);
    body.tracked = tracked;
    frame.bodies = {body};
    server.send(frame);
  });
  start_with("source: natnet\nserver: " + server.name() + "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n  kl1: {id: 42, " +
             kBodyKeys + "}\n");
  ASSERT_NO_FATAL_FAILURE(hover());
  Inbox<bool> untracked;
  const auto poses = watcher_->subscribe<comms::msg::MocapPose>(
      comms::topics::kMocapPose, [&](const auto& pose) { if (!pose.tracked()) untracked.put(true); });
  tracked = false;
  EXPECT_TRUE(untracked.wait_for_count(1));
  EXPECT_TRUE(wait_until_rotors_off()) << mode_log();
}

class MotionCaptureOptions : public testing::Test {
 protected:
  std::string refusal(const std::vector<std::string>& arguments) const {
    const ProgramResult result = run_program("swiftlet-mocap", arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 2) << result.errors;
    return result.errors;
  }
  const TemporaryFolder folder_;
};

TEST_F(MotionCaptureOptions, ThatDoNotGoTogetherAreRefused) {
  const struct {
    std::vector<std::string> arguments;
    std::string sentence;
  } cases[] = {
      {{"--server", "lab1"}, "--server: not with --source simulation"},
      {{"--source", "natnet"}, "--frame is required without --room: zup or yup, as the motion capture is set"},
      {{"--source", "natnet", "--frame", "zup", "--clock", "lockstep"}, "--clock lockstep: only with --source simulation"},
      {{"--source", "vrpn", "--frame", "zup"}, "--source vrpn needs --server"},
      {{"--source", "replay", "--frame", "zup"}, "--source replay needs --file"},
      {{"--source", "vrpn", "--frame", "zup", "--server", "127.0.0.1:99999"}, "server: is '127.0.0.1:99999', must be"},
      {{"--source", "vicon", "--frame", "zup", "--mocap-interface", "eth99"}, "interface: is 'eth99', must be"},
      {{"--room", "optitrack", "--vehicle-name", "kl9"}, "vehicles: does not have the vehicle kl9"},
  };
  for (const auto& one : cases) EXPECT_NE(refusal(one.arguments).find(one.sentence), std::string::npos) << one.sentence << "\n" << refusal(one.arguments);
}

}  // namespace
}  // namespace swiftlet::tests

// Flies through real motion capture protocols: a scripted server sends what the plant's ground truth says, as cameras would
// see it, and swiftlet-mocap brings it to control.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/math/statistics.hpp"
#include "swiftlet/recording/flight_record.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/mocap/natnet_server.hpp"
#include "tests/support/mocap/vrpn_server.hpp"
#include "tests/support/plant_log.hpp"
#include "tests/support/separate_processes.hpp"
#include "tests/support/terminal.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using nlohmann::json;

constexpr std::int64_t kHourNs = 3'600'000'000'000;
constexpr std::int32_t kBody = 42;

const Vector3d kLeverArm(0.01, -0.02, 0.03);
const Vector3d kMisalignment(0.0, 0.0, 0.35);  // rad
const std::string kBodyKeys = "lever_arm_frd_m: [0.01, -0.02, 0.03], misalignment_rad: [0, 0, 0.35]";

struct Pose {
  Vector3d position;
  Quaterniond attitude;
};

// The pose of the body that is fixed to the vehicle like this, with the noise of cameras: they see no pose twice.
Pose body_of(const comms::msg::GroundTruth& truth) {
  constexpr double kNoiseM = 2e-5;
  const double phase = 1e-6 * static_cast<double>(truth.stamp_ns());
  const Vector3d noise = kNoiseM * Vector3d(std::sin(phase), std::sin(2.0 * phase), std::cos(phase));
  const auto& p = truth.position_ned();
  const auto& q = truth.q_ned_from_frd();
  const Quaterniond vehicle(q[0], q[1], q[2], q[3]);
  const Quaterniond turn(Eigen::AngleAxisd(kMisalignment.norm(), kMisalignment.normalized()));
  return {Vector3d(p[0], p[1], p[2]) - vehicle * kLeverArm + noise, vehicle * turn.conjugate()};
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

natnet::Frame frame_of(natnet::Body body, std::int32_t number, const Pose& pose) {
  for (int i = 0; i < 3; ++i) body.position[i] = static_cast<float>(pose.position[i]);
  for (int i = 0; i < 4; ++i) body.q_xyzw[i] = static_cast<float>(pose.attitude.coeffs()[i]);
  natnet::Frame frame;
  frame.number = number;
  frame.bodies = {body};
  return frame;
}

// How far poses are from where the vehicle was at their stamps: medians.
struct PoseErrors {
  std::size_t count = 0;
  double position_m = 1e9;
  double attitude_rad = 1e9;
};

PoseErrors errors_of(const std::vector<comms::msg::MocapPose>& poses,
                     const std::vector<ground::TruthRow>& truth) {
  const auto position = [](const auto& row) { return Vector3d(row.position_ned.data()); };
  const auto attitude = [](const auto& q) { return Quaterniond(q[0], q[1], q[2], q[3]); };
  std::vector<double> positions_m;
  std::vector<double> attitudes_rad;
  for (const comms::msg::MocapPose& pose : poses) {
    const auto after =
        std::lower_bound(truth.begin(), truth.end(), pose.stamp_ns(),
                         [](const auto& row, std::int64_t stamp_ns) { return row.stamp_ns < stamp_ns; });
    if (!pose.tracked() || after == truth.begin() || after == truth.end()) continue;
    const auto before = after - 1;
    const double part = static_cast<double>(pose.stamp_ns() - before->stamp_ns) /
                        static_cast<double>(after->stamp_ns - before->stamp_ns);
    const Vector3d there = position(*before) + part * (position(*after) - position(*before));
    const Quaterniond turned = attitude(before->q_ned_from_frd).slerp(part, attitude(after->q_ned_from_frd));
    positions_m.push_back((Vector3d(pose.position_ned().data()) - there).norm());
    attitudes_rad.push_back(attitude(pose.q_ned_from_frd()).angularDistance(turned));
  }
  return {positions_m.size(), ground::spread(positions_m).median, ground::spread(attitudes_rad).median};
}

// A machine that stalls holds back the simulated vehicle's clock, and poses are withheld until it is known again.
constexpr double kStalledMs = 100.0;        // in a flight: it is not tracked as closely
constexpr double kStalledOftenMs = 1000.0;  // the vehicle may have to land

class MotionCapture : public SeparateProcesses {
 protected:
  // Calls `show` with each ground truth: 100 times per second.
  void film(std::function<void(const comms::msg::GroundTruth&)> show) {
    cameras_ = watcher_->subscribe<comms::msg::GroundTruth>(comms::topics::kGroundTruth, std::move(show));
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
  // Flies a mission: its poses are the vehicle's, and it is tracked within this error of the real pose. If it is not, on a
  // machine that stalls, it is flown again, twice at most.
  void expect_flown(const std::string& room, const std::string& mission, double rms_m) {
    Inbox<comms::msg::MocapPose> poses;
    const auto subscription = watcher_->subscribe<comms::msg::MocapPose>(
        comms::topics::kMocapPose, [&](const auto& pose) { poses.put(pose); });
    ProgramResult result;
    double stalled_ms = 0.0;
    double flown_rms_m = 0.0;
    for (int attempt = 0; attempt < 3; ++attempt) {
      clear_history();
      poses.clear();
      start_with(room);
      if (HasFatalFailure()) return;
      result = run_program("swiftlet",
                           {"fly", mission, "--time-scale", "0.5", "--attach", "--localhost-only", "--domain",
                            std::to_string(lock_.domain()), "--json", "--record",
                            (folder_.path() / "record").string(), "--replace"},
                           folder_.path(), kStuck);
      for (const auto& process : {mocap_.get(), plant_.get(), control_.get()}) {
        process->signal(SIGTERM);
        EXPECT_EQ(process->wait(kStuck), 0) << process->errors();
      }
      stalled_ms = behind_real_time_ms(plant_->errors());
      if (result.exit_code == 0) flown_rms_m = json::parse(result.output).at("rms_3d_m").get<double>();
      if (stalled_ms < kStalledMs || (result.exit_code == 0 && flown_rms_m < rms_m)) break;
    }
    const PoseErrors errors = errors_of(poses.items(), truth());
    EXPECT_GT(errors.count, 500U);
    EXPECT_LT(errors.position_m, 1e-3);
    EXPECT_LT(errors.attitude_rad, 2e-3);
    if (result.exit_code == 0) {
      RecordProperty("rms_3d_um", static_cast<int>(std::lround(1e6 * flown_rms_m)));
      EXPECT_LT(flown_rms_m, stalled_ms < kStalledMs ? rms_m : 0.05) << stalled_ms;
    } else {
      EXPECT_GT(stalled_ms, kStalledOftenMs) << result.errors << mocap_->errors() << control_->errors();
    }
  }
  // Takes off, and again if the vehicle has landed instead, on a machine that stalls.
  bool takes_off() {
    const auto has = [](const std::vector<std::string>& modes, const std::string& mode) {
      return std::find(modes.begin(), modes.end(), mode) != modes.end();
    };
    const std::string hovers = "holding: take-off completed";
    for (int attempt = 0; attempt < 5; ++attempt) {
      if (!eventually([&] { return ask(comms::msg::Command_Constants::ARM).accepted(); })) return false;
      clear_history();
      const auto start = client_->view().truth.message.position_ned();
      if (!ask(comms::msg::Command_Constants::TAKEOFF).accepted()) return false;
      bool has_landed = false;
      const bool has_ended = eventually([&] {
        const auto modes = mode_log_.items();
        has_landed = has(modes, "taking off: requested") && modes.back().rfind("disarmed: ", 0) == 0;
        return has_landed || (has(modes, hovers) && distance_m(start[0], start[1], -1) < 0.05);
      });
      if (!has_landed) return has_ended;
    }
    return false;
  }
  std::string hop() const {
    std::string file = (folder_.path() / "hop.yaml").string();
    std::ofstream(file) << kHopMission;
    return file;
  }

  comms::Subscription cameras_;
};

// GIVEN a server of NatNet 4.1 with y up, an hour ahead, whose body is turned by 20 degrees and 4 cm off THEN the square is
// flown at 1 m/s as closely as with the simulated motion capture.
TEST_F(MotionCapture, FliesTheSquareThroughNatNet) {
  NatNetServer::Settings settings;
  settings.clock_offset_ns = kHourNs;
  NatNetServer server(settings);
  server.set_models({{"drone", kBody}});
  film([&server, number = 0](const auto& truth) mutable {
    server.send(frame_of({"drone", kBody}, ++number, with_y_up(body_of(truth))));
  });
  const std::string room = "source: natnet\nserver: " + server.name() +
                           "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n  kl1: {body: drone, " +
                           kBodyKeys + "}\n";
  expect_flown(room, "square", 0.008);
  EXPECT_NE(mocap_->errors().find("kl1 is body 'drone' with number 42"), std::string::npos)
      << mocap_->errors();
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
  const std::string room = "source: vrpn\nserver: " + server.name() +
                           "\nframe: zup\nvehicles:\n  kl1: {body: drone, " + kBodyKeys + "}\n";
  expect_flown(room, hop(), 0.01);
}

// GIVEN a body that is lost in flight THEN control hears so at once, and the vehicle lands as it does without poses.
TEST_F(MotionCapture, ReportsABodyThatIsLost) {
  NatNetServer server({});
  server.set_models({{"kl1", kBody}});
  std::atomic<bool> tracked{true};
  film([&, number = 0](const auto& truth) mutable {
    natnet::Body body{"kl1", kBody};
    body.tracked = tracked;
    server.send(frame_of(body, ++number, with_y_up(body_of(truth))));
  });
  start_with("source: natnet\nserver: " + server.name() +
             "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n  kl1: {id: 42, " + kBodyKeys + "}\n");
  ASSERT_TRUE(takes_off()) << mode_log() << control_->errors();
  Inbox<bool> untracked;
  const auto poses =
      watcher_->subscribe<comms::msg::MocapPose>(comms::topics::kMocapPose, [&](const auto& pose) {
        if (!pose.tracked()) untracked.put(true);
      });
  tracked = false;
  EXPECT_TRUE(untracked.wait_for_count(1));
  EXPECT_TRUE(wait_until_rotors_off()) << mode_log();
}

// GIVEN a vehicle that is still, whose clock is slow WHEN its IMU is compared with its poses THEN gravity tells roll and pitch, and
// nothing the lever arm.
TEST_F(MotionCapture, IsCalibratedByTheImuOfAVehicle) {
  control_ = start("swiftlet-control", {"--clock", "lockstep"});
  plant_ = start("swiftlet-plant", {"--clock", "lockstep", "--speed", "0.8"});
  mocap_ = start("swiftlet-mocap", {"--clock", "lockstep"});
  wait_until_ready();
  const std::string room = (folder_.path() / "room.yaml").string();
  const std::string text = "source: natnet\nframe: yup\nvehicles:\n  kl1: {body: drone, " + kBodyKeys + "}\n";
  std::ofstream(room) << text;
  const ProgramResult result =
      run_program("swiftlet",
                  {"mocap", "calibrate", "kl1", "--room", room, "--hover", "--time", "5", "--dry-run",
                   "--json", "--localhost-only", "--domain", std::to_string(lock_.domain())},
                  folder_.path(), kStuck);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  const json found = json::parse(result.output);
  const json& deviation = found.at("misalignment_deviation_rad");
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_LT(deviation[axis].get<double>(), 15e-3) << axis;
    EXPECT_NEAR(found.at("misalignment_rad")[axis].get<double>(), kMisalignment[axis], 4.0 * 11e-3) << axis;
  }
  EXPECT_TRUE(found.at("lever_arm_deviation_m")[2].is_null());
  EXPECT_NEAR(found.at("lever_arm_frd_m")[2].get<double>(), kLeverArm.z(), 2e-3);
  EXPECT_GT(found.at("poses").get<int>(), 300);
  std::ifstream file(room);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
}

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
  const auto send = [&](const Quaterniond& vehicle) {
    comms::msg::GroundTruth truth;
    truth.position_ned({1.0, 2.0, -0.5});
    truth.q_ned_from_frd({vehicle.w(), vehicle.x(), vehicle.y(), vehicle.z()});
    server.send(frame_of({"drone", kBody}, ++number, with_y_up(body_of(truth))));
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

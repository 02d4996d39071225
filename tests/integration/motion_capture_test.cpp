// Flies through real motion capture protocols: a scripted server sends what the plant's ground truth says, as cameras would
// see it. In real time swiftlet-mocap brings it to control. In lockstep the test does, with the receivers of swiftlet-mocap.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/math/statistics.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/record/flight.hpp"
#include "swiftlet/services/clocks/clock_client.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/mocap/sources/source.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "tests/integration/filmed_body.hpp"
#include "tests/support/hop_mission.hpp"
#include "tests/support/mocap/natnet_server.hpp"
#include "tests/support/mocap/vrpn_server.hpp"
#include "tests/support/paths.hpp"
#include "tests/support/separate_processes.hpp"

namespace swiftlet::tests {
namespace {

using namespace filmed_body;
using nlohmann::json;
namespace msg = messages::msg;

constexpr std::int64_t kHourNs = 3'600'000'000'000;
const std::string kBodyKeys = "lever_arm_frd_m: [0.01, -0.02, 0.03], misalignment_rad: [0, 0, 0.35]";

std::string natnet_room(const NatNetServer& server, const std::string& vehicle) {
  return "source: natnet\nserver: " + server.name() + "\ninterface: 127.0.0.1\nframe: yup\nvehicles:\n  " +
         vehicle + ": {body: drone, " + kBodyKeys + "}\n";
}
std::string vrpn_room(const VrpnServer& server, const std::string& vehicle) {
  return "source: vrpn\nserver: " + server.name() + "\nframe: zup\nvehicles:\n  " + vehicle +
         ": {body: drone, " + kBodyKeys + "}\n";
}

// Cameras that see a vehicle: show(pose, age_ns) sends the pose that it had age_ns ago. They own their server.
using Cameras = std::function<void(const PoseSample& vehicle, std::int64_t age_ns)>;

Cameras natnet_cameras(std::shared_ptr<NatNetServer> server,
                       std::shared_ptr<const std::atomic<bool>> tracked) {
  server->set_models({{"drone", kBody}});
  return [server = std::move(server), tracked = std::move(tracked), number = 0](const PoseSample& vehicle,
                                                                                std::int64_t age_ns) mutable {
    natnet::Body body{"drone", kBody};
    body.tracked = *tracked;
    server->send(frame_of(body, ++number, with_y_up(body_of(vehicle))), age_ns);
  };
}
Cameras vrpn_cameras(std::shared_ptr<VrpnServer> server) {
  return [server = std::move(server)](const PoseSample& vehicle, std::int64_t age_ns) {
    const Pose pose = with_z_up(body_of(vehicle));
    const Vector3d& p = pose.position;
    const Eigen::Vector4d q = pose.attitude.coeffs();
    server->send(1, {p.x(), p.y(), p.z(), q[0], q[1], q[2], q[3]}, age_ns);
  };
}

// How far poses are from where the vehicle was at their stamps while it moved: medians.
struct PoseErrors {
  std::size_t count = 0;
  double position_m = 1e9;
  double attitude_rad = 1e9;
};

PoseErrors errors_of(const std::vector<msg::MocapPose>& poses, const std::vector<record::TruthRow>& truth) {
  constexpr double kMoves_m_s = 0.2;
  const auto position = [](const auto& row) { return Vector3d(row.position_ned.data()); };
  const auto attitude = [](const auto& q) { return Quaterniond(q[0], q[1], q[2], q[3]); };
  std::vector<double> positions_m;
  std::vector<double> attitudes_rad;
  for (const msg::MocapPose& pose : poses) {
    const auto after =
        std::lower_bound(truth.begin(), truth.end(), pose.stamp_ns(),
                         [](const auto& row, std::int64_t stamp_ns) { return row.stamp_ns < stamp_ns; });
    if (!pose.tracked() || after == truth.begin() || after == truth.end()) continue;
    if (Vector3d(after->velocity_ned.data()).norm() < kMoves_m_s) continue;
    const auto before = after - 1;
    const double part = static_cast<double>(pose.stamp_ns() - before->stamp_ns) /
                        static_cast<double>(after->stamp_ns - before->stamp_ns);
    const Vector3d there = position(*before) + part * (position(*after) - position(*before));
    const Quaterniond turned = attitude(before->q_ned_from_frd).slerp(part, attitude(after->q_ned_from_frd));
    positions_m.push_back((Vector3d(pose.position_ned().data()) - there).norm());
    attitudes_rad.push_back(attitude(pose.q_ned_from_frd()).angularDistance(turned));
  }
  if (positions_m.empty()) return {};
  return {positions_m.size(), math::spread(positions_m).median, math::spread(attitudes_rad).median};
}

// In place of swiftlet-mocap, in lockstep with the plant: what the cameras send of each frame that is due is received as
// swiftlet-mocap does, and published with the stamp of the exposure.
class LockstepCapture {
 public:
  LockstepCapture(const dds::NodeSettings& network, const std::string& room, Cameras cameras)
      : room_(mocap::parse_room(room, "room")),
        source_(mocap::open_source(room_)),
        cameras_(std::move(cameras)),
        node_(network),
        poses_(node_.publish(messages::topics::kMocapPose)) {
    connect();
    truth_ = node_.subscribe<msg::GroundTruth>(messages::topics::kGroundTruth,
                                               [this](const auto& message) { on_truth(message); });
  }

 private:
  static plant::MocapSettings settings() {
    plant::MocapSettings settings =
        io::load_simulation_settings(in_source("config/simulation/default.yaml")).mocap;
    settings.position_error_m = settings.orientation_error_rad = settings.misalignment_rad = 0.0;
    return settings;
  }

  void connect() {
    EXPECT_TRUE(eventually([&] {
      cameras_({}, 0);
      source_->receive(frame_, std::chrono::milliseconds(10));
      return mocap::find_body(source_->bodies(), room_.vehicles.front()).has_value();
    })) << source_->description();
    while (source_->receive(frame_, std::chrono::milliseconds(20))) {
    }
  }

  void on_truth(const msg::GroundTruth& message) {
    plant::TruthSample truth;
    if (messages::from_message(message, truth)) return;
    if (truth.sequence > newest_) {
      newest_ = truth.sequence;
      const std::optional<PoseSample> exposed = exposures_.update(truth);
      answer_ = exposed ? messages::to_message(captured(*exposed)) : msg::MocapPose();
      if (!exposed) answer_.stamp_ns(truth.stamp_ns);
    }
    poses_.publish(answer_);
  }

  PoseSample captured(const PoseSample& exposed) {
    PoseSample sample;
    sample.stamp_ns = exposed.stamp_ns;
    sample.sequence = exposed.sequence;
    cameras_(exposed, 0);
    if (!source_->receive(frame_, std::chrono::seconds(1))) {
      ADD_FAILURE() << "frame " << exposed.sequence << " does not arrive: " << source_->description();
      return sample;
    }
    const auto body = mocap::find_body(source_->bodies(), room_.vehicles.front());
    for (const mocap::BodyPose& pose : frame_.poses) {
      if (pose.body != body || !pose.tracked) continue;
      const mocap::NedPose ned =
          mocap::RoomFrame(room_).vehicle_pose(pose.position, pose.q_room_from_body, room_.vehicles.front());
      sample.tracked = true;
      sample.position_ned = ned.position_ned;
      sample.q_ned_from_frd = ned.q_ned_from_frd;
    }
    return sample;
  }

  const mocap::Room room_;
  const std::unique_ptr<mocap::Source> source_;
  const Cameras cameras_;
  plant::Mocap exposures_{settings(), 1};
  mocap::SourceFrame frame_;
  std::uint64_t newest_ = 0;
  msg::MocapPose answer_;
  dds::Node node_;
  dds::Publisher<msg::MocapPose> poses_;
  dds::Subscription truth_;  // last: its callback uses all members above
};

class MotionCapture : public SeparateProcesses {
 protected:
  std::string hop() const { return folder_.write("hop.yaml", kHopMission); }
  // `swiftlet fly` with a running vehicle, at twice the speed of the mission.
  std::vector<std::string> attach(const std::string& mission, const std::string& vehicle) const {
    return {"fly",
            mission,
            "--time-scale",
            "0.5",
            "--attach",
            "--vehicle-name",
            vehicle,
            "--localhost-only",
            "--domain",
            std::to_string(lock_.domain()),
            "--json",
            "--record",
            (folder_.path() / ("record-" + vehicle)).string()};
  }
  // Starts the vehicle and control in lockstep with these cameras, flies the mission, and expects that the vehicle is tracked
  // within this error of its real pose.
  void expect_flown_in_lockstep(const std::string& room, Cameras cameras, const std::string& mission,
                                double rms_m) {
    dds::NodeSettings network = node("mocap");
    capture_.emplace(network, room, std::move(cameras));
    poses_.emplace();
    seen_ = watcher_->subscribe<msg::MocapPose>(messages::topics::kMocapPose, [this](const auto& pose) {
      if (pose.sequence_number() > 0) poses_->put(pose);
    });
    control_ = start("swiftlet-control", {"--clock", "lockstep"});
    plant_ = start("swiftlet-plant", {"--clock", "lockstep", "--speed", "10"});
    ASSERT_NO_FATAL_FAILURE(wait_until_ready());
    const ProgramResult result = run_program("swiftlet", attach(mission, "kl1"), folder_.path(), kStuck);
    ASSERT_EQ(result.exit_code, 0) << result.errors << control_->errors();
    const double flown_rms_m = json::parse(result.output).at("rms_3d_m").get<double>();
    RecordProperty("rms_3d_um", static_cast<int>(std::lround(1e6 * flown_rms_m)));
    EXPECT_LT(flown_rms_m, rms_m);
    expect_close(errors_of(poses_->items(), truth()));
  }
  static void expect_close(const PoseErrors& errors) {
    EXPECT_GT(errors.count, 200U);
    EXPECT_LT(errors.position_m, 1e-3);
    EXPECT_LT(errors.attitude_rad, 2e-3);
  }

  std::optional<LockstepCapture> capture_;
  std::optional<Inbox<msg::MocapPose>> poses_;
  dds::Subscription seen_;
};

// GIVEN a server of NatNet 4.1 with y up, whose body is turned by 20 degrees and 4 cm off THEN the square is flown at 1 m/s as
// closely as with the simulated motion capture. WHEN the body is lost in flight THEN the vehicle lands as it does without poses.
TEST_F(MotionCapture, FliesTheSquareThroughNatNetInLockstepAndLandsWithoutItsBody) {
  const auto server = std::make_shared<NatNetServer>(NatNetServer::Settings());
  const auto tracked = std::make_shared<std::atomic<bool>>(true);
  ASSERT_NO_FATAL_FAILURE(expect_flown_in_lockstep(natnet_room(*server, "kl1"),
                                                   natnet_cameras(server, tracked), "square", 0.008));
  ASSERT_NO_FATAL_FAILURE(hover());
  *tracked = false;
  EXPECT_TRUE(poses_->wait([](const std::vector<msg::MocapPose>& poses) { return !poses.back().tracked(); }));
  EXPECT_TRUE(reported(control::Mode::kDescent, "no mocap pose")) << mode_log();
  EXPECT_TRUE(wait_until_rotors_off()) << mode_log();
}

TEST_F(MotionCapture, FliesThroughVrpnInLockstep) {
  VrpnServer::Settings settings;
  settings.trackers = {"other", "drone"};
  const auto server = std::make_shared<VrpnServer>(settings);
  expect_flown_in_lockstep(vrpn_room(*server, "kl1"), vrpn_cameras(server), hop(), 0.01);
}

// A vehicle in real time with cameras, which know at what time of this host each of its poses was.
class FilmedVehicle {
 public:
  FilmedVehicle(const dds::NodeSettings& network, Cameras cameras)
      : node_(network), clock_(node_, runtime::monotonic_ns, clocks::ClockClient::Reporting::kNone) {
    poses_ = node_.subscribe<msg::MocapPose>(messages::topics::kMocapPose,
                                             [this](const auto& pose) { seen_.put(pose); });
    truth_ = node_.subscribe<msg::GroundTruth>(
        messages::topics::kGroundTruth, [this, cameras = std::move(cameras)](const auto& message) {
          clock_.ask_if_due();
          const auto vehicle_now_ns = clock_.to_vehicle(runtime::monotonic_ns());
          plant::TruthSample truth;
          if (!vehicle_now_ns || messages::from_message(message, truth)) return;
          const std::int64_t age_ns = *vehicle_now_ns - truth.stamp_ns;
          cameras({truth.stamp_ns, 0, true, truth.position_ned, truth.q_ned_from_frd},
                  std::max<std::int64_t>(age_ns, 1));
        });
  }
  const Inbox<msg::MocapPose>& seen() const { return seen_; }

 private:
  Inbox<msg::MocapPose> seen_;
  dds::Node node_;
  clocks::ClockClient clock_;
  dds::Subscription poses_;
  dds::Subscription truth_;  // last: its callback uses all members above
};

// GIVEN a vehicle by a server of NatNet, an hour ahead, and one by a server of VRPN, an hour behind, in real time WHEN they fly a
// mission THEN the poses are theirs at their stamps. WHEN a body is lost THEN control hears so.
TEST_F(MotionCapture, StampsThePosesOfNatNetAndVrpnByTheVehiclesClocks) {
  NatNetServer::Settings natnet_settings;
  natnet_settings.clock_offset_ns = kHourNs;
  const auto natnet_server = std::make_shared<NatNetServer>(natnet_settings);
  VrpnServer::Settings vrpn_settings;
  vrpn_settings.trackers = {"other", "drone"};
  vrpn_settings.clock_offset_ns = -kHourNs;
  const auto vrpn_server = std::make_shared<VrpnServer>(vrpn_settings);
  const auto tracked = std::make_shared<std::atomic<bool>>(true);

  const auto network_of = [this](const char* name, const char* vehicle) {
    dds::NodeSettings network = node(name);
    network.vehicle = vehicle;
    return network;
  };
  const FilmedVehicle by_natnet(network_of("cameras", "kl1"), natnet_cameras(natnet_server, tracked));
  const FilmedVehicle by_vrpn(network_of("cameras", "kl2"), vrpn_cameras(vrpn_server));
  const ground::Client client_of_kl2(network_of("ground", "kl2"));
  dds::Node watcher_of_kl2(network_of("watcher", "kl2"));
  const TelemetryLog telemetry_of_kl2(watcher_of_kl2);

  control_ = start("swiftlet-control", {"--vehicle-name", "kl1,kl2"});
  plant_ = start("swiftlet-plant", {"--vehicle-name", "kl1,kl2"});
  mocap_ = start("swiftlet-mocap", {"--vehicle-name", "kl1", "--room",
                                    folder_.write("natnet.yaml", natnet_room(*natnet_server, "kl1"))});
  const auto other_mocap =
      start("swiftlet-mocap",
            {"--vehicle-name", "kl2", "--room", folder_.write("vrpn.yaml", vrpn_room(*vrpn_server, "kl2"))});
  ASSERT_NO_FATAL_FAILURE(wait_until_ready());
  ASSERT_TRUE(client_of_kl2.wait(kStuck,
                                 [](const ground::View& view) {
                                   return view.control.message.has_pose() && view.truth.seen() &&
                                          view.battery.seen();
                                 }))
      << control_->errors() << other_mocap->errors();

  Program fly_kl1("swiftlet", attach(hop(), "kl1"), folder_.path());
  Program fly_kl2("swiftlet", attach(hop(), "kl2"), folder_.path());
  EXPECT_EQ(fly_kl1.wait(kStuck), 0) << fly_kl1.errors() << mocap_->errors() << control_->errors();
  EXPECT_EQ(fly_kl2.wait(kStuck), 0) << fly_kl2.errors() << other_mocap->errors() << control_->errors();
  expect_close(errors_of(by_natnet.seen().items(), truth()));
  expect_close(errors_of(by_vrpn.seen().items(), telemetry_of_kl2.flight().truth));

  EXPECT_TRUE(by_natnet.seen().items().back().tracked());
  *tracked = false;
  EXPECT_TRUE(by_natnet.seen().wait(
      [](const std::vector<msg::MocapPose>& poses) { return !poses.back().tracked(); }));
  for (Program* const process : {mocap_.get(), other_mocap.get(), plant_.get(), control_.get()}) {
    process->signal(SIGTERM);
    EXPECT_EQ(process->wait(kStuck), 0) << process->errors();
  }
  EXPECT_NE(mocap_->errors().find("kl1 is body 'drone' with number 42"), std::string::npos)
      << mocap_->errors();
}

// GIVEN a vehicle that is still, whose clock is fast WHEN its IMU is compared with its poses THEN gravity tells roll and pitch, and
// nothing the lever arm.
TEST_F(MotionCapture, IsCalibratedByTheImuOfAVehicle) {
  control_ = start("swiftlet-control", {"--clock", "lockstep"});
  plant_ = start("swiftlet-plant", {"--clock", "lockstep", "--speed", "8"});
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
  EXPECT_NEAR(found.at("poses").get<int>(), 500, 200);
  std::ifstream file(room);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), text);
}

}  // namespace
}  // namespace swiftlet::tests

#include "swiftlet/ground/cli/mocap/calibration.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/ground/cli/mocap/body_statistics.hpp"
#include "swiftlet/ground/cli/mocap/recorded_motion.hpp"
#include "swiftlet/io/mocap/room.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::ground::calibration_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;

const Vector3d kTurn(0.02, -0.03, 0.1);
const Vector3d kArm(0.01, -0.02, 0.035);
constexpr double kSeconds = 20.0;

// Poses of a body that is fixed to a vehicle like this.
class Cameras {
 public:
  explicit Cameras(double noise_m) : noise_m_(noise_m) {}

  mocap::NedPose see(const Vector3d& centre, const Quaterniond& vehicle) {
    mocap::NedPose pose;
    pose.q_ned_from_frd = vehicle * math::rotation(kTurn).conjugate() * math::rotation(0.1 * noise());
    pose.position_ned = centre - vehicle * kArm + noise();
    return pose;
  }
  BodyPoses at_rest(int count) {
    BodyPoses poses;
    for (int i = 0; i < count; ++i) poses.push_back(see({1, 2, 0}, Quaterniond::Identity()));
    return poses;
  }
  // Turned by up to this about the first axes.
  BodyPoses turned(int count, double angle, int axes) {
    BodyPoses poses;
    for (int i = 0; i < count; ++i) {
      const double t = 6.283 * i / count;
      const Vector3d vector(std::sin(3 * t), axes > 1 ? std::sin(5 * t + 1) : 0.0,
                            axes > 2 ? std::sin(7 * t + 2) : 0.0);
      poses.push_back(see({1, 2, -0.5}, math::rotation(angle * vector)));
    }
    return poses;
  }

 private:
  Vector3d noise() { return noise_m_ * Vector3d(normal_(engine_), normal_(engine_), normal_(engine_)); }

  const double noise_m_;
  std::mt19937_64 engine_{3};
  std::normal_distribution<double> normal_;
};

std::string refusal(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Calibration, FindsHowTheBodySits) {
  Cameras cameras(0.0);
  const Misalignment misalignment = misalignment_of(cameras.at_rest(100), 3.0);
  EXPECT_TRUE(misalignment.vector.isApprox(kTurn, 1e-9)) << misalignment.vector;
  const LeverArm arm = lever_arm_of(cameras.turned(2000, 0.6, 3), misalignment, kSeconds);
  EXPECT_TRUE(arm.frd.isApprox(kArm, 1e-9)) << arm.frd;
  EXPECT_LT(arm.residual_m, 1e-9);
}

// With the calibration's result, the room frame puts the vehicle where it is.
TEST(Calibration, IsWhatTheRoomFrameUses) {
  Cameras cameras(0.0);
  mocap::Room room;
  const mocap::RoomFrame frame(room);
  mocap::VehicleBody vehicle;
  vehicle.misalignment = misalignment_of(cameras.at_rest(100), 3.0).vector;
  vehicle.lever_arm_frd = lever_arm_of(cameras.turned(2000, 0.6, 3), {kTurn, {}}, kSeconds).frd;
  const Quaterniond attitude = math::rotation({0.3, 0.2, 0.1});
  const mocap::NedPose body = cameras.see({1, 2, 3}, attitude);
  // Back into the axes of the motion capture, with z up.
  const auto turned = [](const Vector3d& v) { return Vector3d(v.x(), -v.y(), -v.z()); };
  Quaterniond in_room(body.q_ned_from_frd.w(), 0, 0, 0);
  in_room.vec() = turned(body.q_ned_from_frd.vec());
  const mocap::NedPose pose = frame.vehicle_pose(turned(body.position_ned), in_room, vehicle);
  EXPECT_TRUE(pose.position_ned.isApprox(Vector3d(1, 2, 3), 1e-9));
  EXPECT_LT(pose.q_ned_from_frd.angularDistance(attitude), 1e-7);
}

// About 95 of 100 calibrations would be within two standard deviations if the noise were independent. The stated deviation
// assumes that it is not, and is larger.
TEST(Calibration, StatesAnUncertaintyThatHolds) {
  Cameras cameras(0.5e-3);
  int within = 0;
  double largest_m = 0.0;
  for (int i = 0; i < 100; ++i) {
    const LeverArm arm = lever_arm_of(cameras.turned(400, 0.6, 3), {kTurn, {}}, kSeconds);
    if (((arm.frd - kArm).cwiseAbs() - 2.0 * arm.deviation).maxCoeff() < 0.0) ++within;
    largest_m = std::max(largest_m, arm.deviation.maxCoeff());
  }
  EXPECT_GE(within, 95);
  EXPECT_LT(largest_m, 1e-3);
}

TEST(Calibration, RefusesWhatCannotTell) {
  Cameras cameras(0.1e-3);
  const auto turned = [&](double angle, int axes) {
    return refusal([&] { lever_arm_of(cameras.turned(2000, angle, axes), {kTurn, {}}, kSeconds); });
  };
  EXPECT_EQ(turned(0.6, 1),
            "the vehicle was turned too little: turn it by 30 degrees and more about two axes");
  EXPECT_EQ(turned(0.01, 3),
            "the vehicle was turned too little: turn it by 30 degrees and more about two axes");
  EXPECT_EQ(turned(0.6, 3), "accepted");
  EXPECT_NE(refusal([&] { misalignment_of(cameras.turned(2000, 0.6, 3), 3.0); }).find("did not stand still"),
            std::string::npos);
  EXPECT_EQ(refusal([&] { misalignment_of(cameras.at_rest(5), 3.0); }),
            "only 5 tracked poses arrived, 20 are needed");
  Cameras shaken(30e-3);
  EXPECT_NE(refusal([&] {
              lever_arm_of(shaken.turned(300, 0.6, 3), {kTurn, {}}, kSeconds);
            }).find("hold it better"),
            std::string::npos);
}

TEST(Calibration, IsWrittenIntoTheRoomFile) {
  const std::string text =
      "source: natnet\nframe: zup  # as Motive\nvehicles:\n  kl1: {body: a, lever_arm_frd_m: [0, 0, 0], "
      "misalignment_rad: [0, 0, 0]}\n"
      "  kl2: {body: b}\n";
  const std::string written = with_calibration(text, "r", "kl1", {kTurn, {}}, {kArm, {}, 0.0});
  const mocap::Room room = mocap::parse_room(written, "r");
  EXPECT_TRUE(mocap::find(room, "kl1")->lever_arm_frd.isApprox(kArm, 1e-5));
  EXPECT_TRUE(mocap::find(room, "kl1")->misalignment.isApprox(kTurn, 1e-5));
  EXPECT_NE(written.find("# as Motive"), std::string::npos);
  EXPECT_NE(tests::refusal([&] { with_calibration(text, "r", "kl2", {}, {}); }).find("lever_arm_frd_m"),
            std::string::npos);
}

class TwoBodies final : public mocap::Source {
 public:
  TwoBodies() { set_bodies({{"a", 1}, {"b", 2}}); }
  bool receive(mocap::SourceFrame&, std::chrono::milliseconds) override { return false; }
  std::string description() const override { return ""; }
};

TEST(BodyStatistics, CountWhatArrivesOfEachBody) {
  const TwoBodies source;
  BodyStatisticsList list;
  for (int i = 0; i < 4; ++i) {
    mocap::SourceFrame frame;
    frame.arrived_ns = 10'000'000 * (i + (i == 3 ? 5 : 0));
    frame.exposed_ns = frame.arrived_ns - 1'000'000 * (i + 1);
    frame.poses = {{0, true, Vector3d::Ones(), Quaterniond::Identity(), 4, i == 1 ? 2 : 0}};
    if (i > 1) frame.poses.push_back({1, false});
    list.take(frame, source);
  }
  const BodyStatistics& first = list.bodies().at(0);
  EXPECT_EQ(first.frames, 4U);
  EXPECT_EQ(first.untracked, 0U);
  EXPECT_EQ(first.lost_markers, 2U);
  EXPECT_NEAR(first.mean_latency_s(), 2.5e-3, 1e-9);
  EXPECT_NEAR(first.latency_max_s, 4e-3, 1e-9);
  EXPECT_NEAR(first.longest_gap_s, 0.06, 1e-9);
  EXPECT_EQ(list.bodies().at(1).frames, 2U);
  EXPECT_EQ(list.bodies().at(1).untracked, 2U);
}

// A record of several vehicles has a folder for each; that of another one is not taken for this one's.
TEST(RecordedMotion, IsOfItsOwnVehicle) {
  const tests::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "kl2");
  folder.write("kl2/report.json", "{}");
  folder.write("flight.mcap", "");
  try {
    read_motion(folder.path() / "kl2", "kl1", std::nullopt, std::nullopt);
    ADD_FAILURE() << "was not refused";
  } catch (const std::runtime_error& fault) {
    EXPECT_NE(std::string(fault.what()).find("kl2: is a flight of kl2, not of kl1"), std::string::npos)
        << fault.what();
  }
}

}  // namespace swiftlet::ground::calibration_test

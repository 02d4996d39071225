#include "swiftlet/io/mocap/room.hpp"

#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/io/config_error_check.hpp"

namespace swiftlet::mocap::room_test {

using Eigen::Quaterniond;
using Eigen::Vector3d;
using tests::refusal;

const std::string kHead = "source: natnet\nframe: zup\n";

Room room_with(Axes axes) {
  Room room;
  room.axes = axes;
  return room;
}

class Random {
 public:
  Vector3d vector() { return {normal_(engine_), normal_(engine_), normal_(engine_)}; }
  Quaterniond rotation() {
    return Quaterniond(normal_(engine_), normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }

 private:
  std::mt19937_64 engine_{7};
  std::normal_distribution<double> normal_;
};

TEST(RoomFile, IsReadWhole) {
  const Room room = parse_room(
      "source: vrpn\nserver: lab:3883\ninterface: eth0\nframe: yup\norigin_m: [1, 2, 3]\nnorth_rad: "
      "0.5\nlatency_s: 0.01\n"
      "vehicles:\n  kl1: {body: drone, lever_arm_frd_m: [0, 0, 0.02], misalignment_rad: [0, 0, 0.1]}\n"
      "  kl2: {id: 7}\n",
      "room.yaml");
  EXPECT_EQ(room.source, SourceKind::kVrpn);
  EXPECT_EQ(room.server, "lab:3883");
  EXPECT_EQ(room.axes, Axes::kYUp);
  EXPECT_EQ(room.origin, Vector3d(1, 2, 3));
  EXPECT_EQ(room.latency_s, 0.01);
  ASSERT_NE(find(room, "kl1"), nullptr);
  EXPECT_EQ(find(room, "kl1")->body, "drone");
  EXPECT_EQ(find(room, "kl1")->lever_arm_frd, Vector3d(0, 0, 0.02));
  EXPECT_EQ(find(room, "kl2")->id, 7);
  EXPECT_EQ(find(room, "kl3"), nullptr);
}

TEST(RoomFile, IsRefusedWithASentence) {
  const auto fault = [](const std::string& text) { return refusal([&] { parse_room(text, "r"); }); };
  EXPECT_EQ(fault(kHead + "vehicles:\n  kl1: {}\n"),
            "r:4: vehicles.kl1: has neither body nor id, must have one");
  EXPECT_EQ(fault(kHead + "vehicles:\n  kl1: {body: a, lever_arm_frd_m: [0, 0, 2]}\n"),
            "r:4: vehicles.kl1.lever_arm_frd_m[2]: is 2, must be at least -1 and at most 1");
  EXPECT_EQ(fault("source: vrpn\nframe: zup\nvehicles:\n  kl1: {id: 1}\n"),
            "r:1: source: is vrpn, which needs the key server");
  EXPECT_NE(fault("source: natnet\nframe: ned\nvehicles:\n  kl1: {id: 1}\n").find("zup or yup"),
            std::string::npos);
  EXPECT_NE(fault(kHead + "north: 1\nvehicles:\n  kl1: {id: 1}\n").find("nearest is north_rad"),
            std::string::npos);
  EXPECT_EQ(fault(kHead + "vehicles:\n  kl1: {body: a}\n  kl2: {body: a, id: 1}\n  kl3: {body: a}\n"),
            "r:6: vehicles.kl3: is body 'a', which is the vehicle kl1 already");
  EXPECT_NE(fault(kHead + "vehicles: {}\n").find("must name at least one vehicle"), std::string::npos);
}

TEST(RoomFrameAxes, AreForwardRightDown) {
  const RoomFrame z_up(room_with(Axes::kZUp));
  EXPECT_EQ(z_up.body_pose({1, 2, 3}, Quaterniond::Identity()).position_ned, Vector3d(1, -2, -3));
  const RoomFrame y_up(room_with(Axes::kYUp));
  EXPECT_TRUE(y_up.body_pose({1, 2, 3}, Quaterniond::Identity()).position_ned.isApprox(Vector3d(1, 3, -2)));
}

// A turn about the axis that points up is a turn to the left; seen from above NED counts to the right.
TEST(RoomFrameAxes, TurnTheBodyWithThem) {
  const Quaterniond left_z(Eigen::AngleAxisd(0.3, Vector3d::UnitZ()));
  const Quaterniond left_y(Eigen::AngleAxisd(0.3, Vector3d::UnitY()));
  const Quaterniond expected(Eigen::AngleAxisd(-0.3, Vector3d::UnitZ()));
  const Quaterniond from_z = RoomFrame(room_with(Axes::kZUp)).body_pose({}, left_z).q_ned_from_frd;
  const Quaterniond from_y = RoomFrame(room_with(Axes::kYUp)).body_pose({}, left_y).q_ned_from_frd;
  EXPECT_LT(from_z.angularDistance(expected), 1e-12);
  EXPECT_LT(from_y.angularDistance(expected), 1e-12);
}

TEST(RoomFrameAxes, HaveTheOriginAndNorthOfTheRoom) {
  Room room = room_with(Axes::kZUp);
  room.origin = {1, 1, 0};
  room.north_rad = M_PI / 2;  // to the right: along -y of the motion capture
  const NedPose pose = RoomFrame(room).body_pose({1, 0, 0}, Quaterniond::Identity());
  EXPECT_TRUE(pose.position_ned.isApprox(Vector3d(1, 0, 0))) << pose.position_ned;
  // A body that points along the forward axis of the motion capture points to the west.
  EXPECT_TRUE((pose.q_ned_from_frd * Vector3d::UnitX()).isApprox(-Vector3d::UnitY()));
}

// For any pose: lengths and angles stay, and a point fixed to the body moves with it.
TEST(RoomFrameAxes, ConvertRigidly) {
  Random random;
  for (const Axes axes : {Axes::kZUp, Axes::kYUp}) {
    for (int i = 0; i < 100; ++i) {
      Room room = room_with(axes);
      room.origin = random.vector();
      room.north_rad = 0.1 * i - 3.0;
      const RoomFrame frame(room);
      const Vector3d p = random.vector();
      const Vector3d other = random.vector();
      const Quaterniond q = random.rotation();
      const NedPose pose = frame.body_pose(p, q);
      EXPECT_NEAR((pose.position_ned - frame.body_pose(other, q).position_ned).norm(), (p - other).norm(),
                  1e-12);
      // A point one metre ahead of the body, which is its x axis in both conventions.
      const Vector3d ahead = frame.body_pose(p + q * Vector3d::UnitX(), q).position_ned;
      EXPECT_TRUE(ahead.isApprox(pose.position_ned + pose.q_ned_from_frd * Vector3d::UnitX(), 1e-12));
      const Vector3d up = axes == Axes::kZUp ? Vector3d::UnitZ() : Vector3d::UnitY();
      const Vector3d above = frame.body_pose(p + q * up, q).position_ned;
      EXPECT_TRUE(above.isApprox(pose.position_ned - pose.q_ned_from_frd * Vector3d::UnitZ(), 1e-12));
    }
  }
}

TEST(RoomVehicle, IsWhereItsBodySays) {
  Random random;
  Room room = room_with(Axes::kYUp);
  const RoomFrame frame(room);
  VehicleBody vehicle;
  vehicle.lever_arm_frd = {0.01, -0.02, 0.03};
  vehicle.misalignment = {0.05, -0.1, 0.2};
  for (int i = 0; i < 100; ++i) {
    const Vector3d p = random.vector();
    const Quaterniond q = random.rotation();
    const NedPose body = frame.body_pose(p, q);
    const NedPose pose = frame.vehicle_pose(p, q, vehicle);
    const double angle = vehicle.misalignment.norm();
    EXPECT_NEAR(pose.q_ned_from_frd.angularDistance(body.q_ned_from_frd), angle, 1e-9);
    // The misalignment turns about the same axis in both.
    EXPECT_TRUE((pose.q_ned_from_frd * vehicle.misalignment)
                    .isApprox(body.q_ned_from_frd * vehicle.misalignment, 1e-9));
    EXPECT_TRUE(
        pose.position_ned.isApprox(body.position_ned + pose.q_ned_from_frd * vehicle.lever_arm_frd, 1e-9));
  }
}

}  // namespace swiftlet::mocap::room_test

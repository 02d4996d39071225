// Every form of file is flown where --scale, --rotate and --offset put it, and inside --fence.
#include "swiftlet/io/missions/placement.hpp"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/io/missions/mission_file.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/unit/io/missions/format_support.hpp"

namespace swiftlet::io::placement_test {

using Eigen::Vector3d;

FileOptions placed_by(double scale, double rotate_deg, const Vector3d& offset_ned) {
  FileOptions options;
  options.placement = {scale, rotate_deg, offset_ned};
  return options;
}

const std::string kSquare =
    "tolerance_m: 0.1\ngeofence: {min_m: [-1, -1, 0], max_m: [3, 3, 2]}\nitems:\n"
    "  - {kind: takeoff, height_m: 1, speed_m_s: 0.5}\n"
    "  - {kind: waypoint, position_m: [1, 2, 1], yaw_rad: 0.5, speed_m_s: 0.5}\n"
    "  - {kind: path, points: [[1, 2, 1], {position_m: [0, 1, 1.5], yaw_rad: 1}, [1, 0, 1]], speed_m_s: "
    "0.5}\n"
    "  - {kind: land, speed_m_s: 0.5}\n";
const std::string kPlan =
    "{\"fileType\": \"Plan\", \"mission\": {\"items\": [\n"
    "{\"type\": \"SimpleItem\", \"command\": 22, \"frame\": 1, \"params\": [0, 0, 0, 0, 0, 0, -1]},\n"
    "{\"type\": \"SimpleItem\", \"command\": 16, \"frame\": 1, \"params\": [0, 0, 0, 90, 1, 2, -1]},\n"
    "{\"type\": \"SimpleItem\", \"command\": 20, \"frame\": 2, \"params\": [0, 0, 0, 0, 0, 0, 0]}]}}\n";

class PlacementTest : public testing::Test {
 protected:
  MissionFile load(const std::string& name, const std::string& text, const FileOptions& options) const {
    return load_mission_file(folder_.write(name, text), field(), options);
  }
  std::string in_folder(const std::string& sentence) const { return (folder_.path() / sentence).string(); }
  // Along the path of the file's trajectory, at equal times of both.
  void expect_placed_path(const std::string& name, const std::string& text, const FileOptions& options,
                          double precision_m) const {
    const MissionFile plain = load(name, text, {});
    const MissionFile placed = load(name, text, options);
    ASSERT_EQ(placed.mission.segments.size(), plain.mission.segments.size());
    for (std::size_t i = 0; i < plain.mission.segments.size(); ++i) {
      const control::PolynomialSegment& segment = plain.mission.segments[i];
      ASSERT_NEAR(placed.mission.segments[i].duration_s, segment.duration_s, 1e-9);
      for (const double part : {0.0, 0.3, 1.0}) {
        const control::Reference from = control::evaluate(segment, part * segment.duration_s);
        const control::Reference to =
            control::evaluate(placed.mission.segments[i], part * segment.duration_s);
        EXPECT_LT((to.position_ned - options.placement.position(from.position_ned)).norm(), precision_m);
        EXPECT_NEAR(to.yaw_rad, options.placement.yaw(from.yaw_rad), 1e-9);
      }
    }
    EXPECT_TRUE(assumes(placed, "turned by 30 deg clockwise, headings too, moved by (1, -2, -0.5) m"));
  }

  tests::TemporaryFolder folder_;
  FileOptions options_ = placed_by(1.5, 30.0, {1.0, -2.0, -0.5});
};

// A rotation is clockwise seen from above: what was in the north is in the east.
TEST_F(PlacementTest, ScalesThenTurnsThenMoves) {
  const Placement placement{2.0, 90.0, {10.0, 20.0, -3.0}};
  EXPECT_EQ(placement.position({1.0, 0.0, -1.0}), Vector3d(10.0, 22.0, -5.0));
  EXPECT_EQ(placement.position({0.0, 1.0, -1.0}), Vector3d(8.0, 20.0, -5.0));
  EXPECT_DOUBLE_EQ(placement.yaw(0.0), M_PI / 2) << "a heading to the north becomes one to the east";
  EXPECT_EQ(Placement{}.sentence(), "");
  EXPECT_EQ(placement.sentence(),
            "scaled by 2, turned by 90 deg clockwise, headings too, moved by (10, 20, -3) m in NED");
}

TEST_F(PlacementTest, QuarterTurnsAreExact) {
  for (const int quarters : {-5, -4, -3, -2, -1, 0, 1, 2, 3, 4}) {
    const Placement placement{1.0, 90.0 * quarters, Vector3d::Zero()};
    const Vector3d turned = placement.position({3.0, 0.0, 0.0});
    EXPECT_LT((turned - 3.0 * Vector3d(std::cos(M_PI_2 * quarters), std::sin(M_PI_2 * quarters), 0.0)).norm(),
              1e-12);
    EXPECT_EQ(turned.x(), std::round(turned.x())) << quarters;
    EXPECT_EQ(turned.y(), std::round(turned.y())) << quarters;
  }
}

TEST_F(PlacementTest, PlacesPolynomials) {
  expect_placed_path("p.csv",
                     kPolynomialHeader + "\n" + polynomial_row(4.0, 0.0, 1.0, 1.0, 0.7) + "\n" +
                         polynomial_row(4.0, 1.0, -2.0, 1.0, 0.7) + "\n",
                     options_, 1e-9);
}

TEST_F(PlacementTest, PlacesSamples) {
  std::string text = "t,x,y,z,yaw\n";
  const control::PolynomialSegment path = control::minimum_jerk({0, 0, 1}, 0.2, {2, 1, 1.5}, 1.0, 4.0);
  for (int i = 0; i <= 80; ++i) {
    const control::Reference at = control::evaluate(path, 0.05 * i);
    text += io::exact(0.05 * i) + "," + io::exact(at.position_ned.x()) + "," +
            io::exact(at.position_ned.y()) + "," + io::exact(at.position_ned.z()) + "," +
            io::exact(at.yaw_rad) + "\n";
  }
  expect_placed_path("s.csv", text, options_, 1e-9);
}

// Waypoints are planned where they are flown, under the limits there.
TEST_F(PlacementTest, PlacesWaypoints) {
  const MissionFile file = load("w.csv", "x,y,z,yaw\n0,0,1,0\n1,2,1,0\n2,0,1.5,0\n", options_);
  const auto end_of = [&](const control::PolynomialSegment& segment) {
    return control::evaluate(segment, segment.duration_s);
  };
  EXPECT_LT((at_path_start(file).position_ned - Vector3d(1.0, -2.0, -2.0)).norm(), 1e-9);
  const control::Reference end = end_of(file.mission.segments.back());
  const Vector3d expected = options_.placement.position({0.0, 2.0, -1.5});
  EXPECT_LT((end.position_ned - expected).norm(), 1e-6);
  EXPECT_NEAR(end.yaw_rad, M_PI / 2 + M_PI / 6, 1e-9);
}

TEST_F(PlacementTest, PlacesTheItemsAndTheFenceOfAMission) {
  const FileOptions quarter = placed_by(2.0, 90.0, {1.0, 0.0, 0.0});
  const MissionFile file = load("m.yaml", "frame: nwu\n" + kSquare, quarter);
  const auto& items = file.mission.items;
  EXPECT_EQ(items[0].position_ned.z(), -2.0);
  // North 1, west 2, up 1 are (1, -2, -1) in NED.
  EXPECT_EQ(items[1].position_ned, Vector3d(5.0, 2.0, -2.0));
  EXPECT_NEAR(items[1].yaw_rad, M_PI / 2 - 0.5, 1e-12);
  EXPECT_LT((at_path_start(file).position_ned - items[1].position_ned).norm(), 1e-9);
  EXPECT_EQ(items[1].speed, 0.5);
  // North -1 .. 3, west -1 .. 3, up 0 .. 2 are north -1 .. 3, east -3 .. 1.
  EXPECT_EQ(file.mission.bounds.fence_min_ned, Vector3d(-1.0, -2.0, -4.0));
  EXPECT_EQ(file.mission.bounds.fence_max_ned, Vector3d(7.0, 6.0, 0.0));
  EXPECT_EQ(refusal([&] {
              load("m.yaml", "frame: ned\n" + kSquare, placed_by(1.0, 30.0, {0, 0, 0}));
            }),
            in_folder("m.yaml:3: geofence: has sides along the axes: --rotate must be a multiple of 90 "
                      "deg, is 30, unless --fence is given in its place"));
}

TEST_F(PlacementTest, PlacesTheTrajectoryOfAMission) {
  static_cast<void>(folder_.write("p.csv", kPolynomialHeader + "\n" + polynomial_row(4.0, 0.0, 1.0, 1.0)));
  const std::string text =
      "frame: ned\ntolerance_m: 0.1\nends: hovering\nitems:\n"
      "  - {kind: trajectory, file: p.csv, speed_m_s: 0.5}\n";
  expect_placed_path("m.yaml", text, options_, 1e-9);
}

TEST_F(PlacementTest, PlacesAPlanWithItsHome) {
  const MissionFile file = load("q.plan", kPlan, placed_by(2.0, 90.0, {1.0, 0.0, 0.0}));
  const auto& items = file.mission.items;
  ASSERT_EQ(items.size(), 4U);
  EXPECT_EQ(items[0].position_ned.z(), -2.0);
  EXPECT_EQ(items[1].position_ned, Vector3d(-3.0, 2.0, -2.0));
  EXPECT_NEAR(std::abs(items[1].yaw_rad), M_PI, 1e-12);
  EXPECT_EQ(items[2].position_ned, Vector3d(1.0, 0.0, -2.0)) << "home";
}

TEST_F(PlacementTest, AFrameOptionIsForAMissionThatNamesNone) {
  FileOptions options;
  options.frame = MissionFrame::kNwu;
  EXPECT_EQ(load("m.yaml", kSquare, options).mission.items[1].position_ned, Vector3d(1.0, -2.0, -1.0));
  EXPECT_EQ(load("m.yaml", "frame: nwu\n" + kSquare, options).mission.items[1].position_ned,
            Vector3d(1.0, -2.0, -1.0));
  EXPECT_EQ(refusal([&] { load("m.yaml", "frame: ned\n" + kSquare, options); }),
            in_folder("m.yaml:1: frame: is ned, but --frame names nwu"));
  EXPECT_EQ(refusal([&] { load("q.plan", kPlan, options); }),
            in_folder("q.plan: names the frame of each item itself: --frame is for other files"));
}

TEST_F(PlacementTest, EveryFormIsHeldInsideTheFenceOption) {
  FileOptions options;
  options.frame = MissionFrame::kEnu;
  options.fence = Fence{{0.5, 2.5, 0.1}, {-1.0, -1.0, -2.0}};
  const auto refused = [&](const std::string& name, const std::string& text) {
    return refusal([&] { load(name, text, options); });
  };
  const std::string waypoints = "x,y,z\n0,0,1\n2,0.2,1\n0,0.4,1\n";
  const MissionFile file = load("w.csv", waypoints, options);
  EXPECT_TRUE(file.mission.bounds.fenced);
  EXPECT_EQ(file.mission.bounds.fence_min_ned, Vector3d(-1.0, -1.0, -2.0));
  EXPECT_EQ(file.mission.bounds.fence_max_ned, Vector3d(0.5, 2.5, 0.1));
  EXPECT_NE(refused("w.csv", "x,y,z\n0,0,1\n2,1,1\n").find("w.csv:3: x,y,z: in ENU: y is 1.000 m"),
            std::string::npos)
      << refused("w.csv", "x,y,z\n0,0,1\n2,1,1\n");
  const std::string polynomials = kPolynomialHeader + "\n" + polynomial_row(9.0, 0.0, 2.6, 1.0);
  EXPECT_NE(refused("p.csv", polynomials).find("p.csv:2: segment 1 in ENU"), std::string::npos)
      << refused("p.csv", polynomials);
  // In place of the file's own, which the waypoint is inside of.
  EXPECT_NE(refused("m.yaml", kSquare).find("is 2 m, must be inside the fence, -1 to 0.5 m"),
            std::string::npos)
      << refused("m.yaml", kSquare);
  options.frame.reset();
  EXPECT_NE(refused("q.plan", kPlan).find("must be inside the fence, -1 to 0.5 m"), std::string::npos)
      << refused("q.plan", kPlan);
  options.fence = Fence{{-1, -1, -50}, {1, 1, 0}};
  EXPECT_EQ(refused("q.plan", kPlan).rfind("--fence: ", 0), 0U) << refused("q.plan", kPlan);
}

}  // namespace swiftlet::io::placement_test

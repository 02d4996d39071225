// Calibration of a body from simulated flights, whose poses are moved to a body that sits askew.
#include "swiftlet/ground/cli/mocap/flight_calibration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/identification/mocap/body_alignment.hpp"
#include "swiftlet/math/random.hpp"
#include "swiftlet/math/rotation_vector.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "tests/support/campaign.hpp"
#include "tests/unit/analysis/identify/identified_flights.hpp"

namespace swiftlet::ground::flight_calibration_test {

using Eigen::Vector3d;
using identification::align_body;
using identification::BodyAlignment;
using identification::EstimatedVector;
using identification::FlightLog;

// How a body sits, with the defects of its motion capture.
struct Askew {
  Vector3d misalignment;
  Vector3d lever_arm;
  Vector3d tilt;  // of the vertical, rotation vector
  double delay_s = 0.0;

  explicit Askew(std::uint64_t seed) {
    math::RandomStream random(seed, 20261125);
    misalignment = 0.05 * random.normal3();
    lever_arm = 0.03 * random.normal3();
    tilt = 0.003 * Vector3d(random.normal(), random.normal(), 0.0);
    delay_s = 0.004 * random.normal();
  }
  void apply(FlightLog& log) const {
    const Eigen::Quaterniond tilted = math::rotation(tilt);
    for (identification::FlightPose& pose : log.poses) {
      pose.time_s += delay_s;
      pose.position_ned = tilted * (pose.position_ned - pose.q_ned_from_frd * lever_arm);
      pose.q_ned_from_frd = tilted * pose.q_ned_from_frd * math::rotation(misalignment).conjugate();
    }
  }
};

std::string mission(const std::string& items) {
  return "name: short\nframe: ned\ntolerance_m: 0.2\nitems:\n" + items + "  - {kind: land, speed_m_s: 0.5}\n";
}

LaunchConfiguration flight_of(const std::string& mission) {
  LaunchConfiguration plan = analysis::plan_of(mission);
  plan.simulation.mocap.misalignment_rad = 0.0;
  return plan;
}

struct Tally {
  int count = 0;
  int covered = 0;
  double square = 0.0;  // sum of squares of error over deviation
  double largest = 0.0;
  double deviation = 0.0;

  void add(double error, double stated) {
    ++count;
    covered += std::abs(error) <= 1.96 * stated ? 1 : 0;
    square += error * error / (stated * stated);
    largest = std::max(largest, std::abs(error) / stated);
    deviation += stated;
  }
};

struct Tallies {
  Tally misalignment[3];
  Tally lever_arm[3];
};

// Flies, calibrates, and counts how often the intervals hold of what was told.
Tallies calibrate(const char* flight, const LaunchConfiguration& plan, int seeds) {
  Tallies out;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Askew askew(static_cast<std::uint64_t>(seed));
    FlightLog log = analysis::flown(plan, plan.vehicle, static_cast<std::uint64_t>(seed));
    askew.apply(log);
    const BodyAlignment found = align_body(log, {});
    const FlightCalibration calibration = calibrated({}, found);
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (calibration.misalignment_told[axis])
        out.misalignment[i].add(found.misalignment.value[i] - askew.misalignment[i],
                                found.misalignment.deviation[i]);
      if (calibration.lever_arm_told[axis])
        out.lever_arm[i].add(found.lever_arm.value[i] - askew.lever_arm[i], found.lever_arm.deviation[i]);
    }
  }
  const auto check = [&](const char* what, const char* unit, const Tally* tallies) {
    for (int i = 0; i < 3; ++i) {
      const Tally& tally = tallies[i];
      if (tally.count == 0) continue;
      std::printf("%-12s %-18s told %d of %d, covered %d, two deviations %.2f %s\n", flight,
                  (std::string(what) + " " + "xyz"[i]).c_str(), tally.count, seeds, tally.covered,
                  2e3 * tally.deviation / tally.count, unit);
      EXPECT_LT(tally.largest, 4.0) << what << i;
      if (tests::is_soak()) {
        EXPECT_GE(tally.covered, tests::least_covered(tally.count)) << what << i;
      }
    }
  };
  check("misalignment", "mrad", out.misalignment);
  check("lever arm", "mm", out.lever_arm);
  return out;
}

// A hover shows the direction of gravity, and nothing of the lever arm.
TEST(FlightCalibration, TellsRollAndPitchFromAHover) {
  const int seeds = tests::draws(2, 60);
  const tests::TemporaryFolder folder;
  const Tallies found =
      calibrate("hover",
                flight_of(folder.write(
                    "hover.yaml", mission("  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: 10}\n"))),
                seeds);
  EXPECT_EQ(found.misalignment[0].count, seeds);
  EXPECT_EQ(found.misalignment[1].count, seeds);
  EXPECT_EQ(found.lever_arm[0].count + found.lever_arm[1].count + found.lever_arm[2].count, 0);
}

TEST(FlightCalibration, TellsTheMisalignmentFromAShortSquare) {
  const int seeds = tests::draws(2, 60);
  const tests::TemporaryFolder folder;
  const Tallies found = calibrate("square", flight_of(folder.write("square.yaml", mission(R"(
  - {kind: takeoff, height_m: 1, speed_m_s: 0.5, hold_s: 3}
  - {kind: waypoint, position_m: [0.4, 0, -1], speed_m_s: 1}
  - {kind: waypoint, position_m: [0.4, 0.4, -1], speed_m_s: 1}
  - {kind: waypoint, position_m: [0, 0.4, -1], speed_m_s: 1}
  - {kind: waypoint, position_m: [0, 0, -1], speed_m_s: 1}
)"))),
                                  seeds);
  for (const Tally& axis : found.misalignment) EXPECT_EQ(axis.count, seeds);
}

TEST(FlightCalibration, TellsAllFromTheMissionCalibration) {
  const int seeds = tests::draws(2, 60);
  const Tallies found = calibrate("calibration", flight_of("calibration"), seeds);
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(found.misalignment[i].count, seeds) << i;
    EXPECT_EQ(found.lever_arm[i].count, seeds) << i;
  }
}

// On the ground, for 6 s; body and vehicle have the same axes.
FlightLog standing(std::uint64_t seed) {
  math::RandomStream random(seed, 20261126);
  FlightLog log;
  for (int i = 0; i < 3000; ++i) {
    log.time_s.push_back(0.002 * i);
    log.specific_force_frd.push_back(Vector3d(0.0, 0.0, -plant::kGravity) + 0.06 * random.normal3());
    log.body_rates_frd.push_back(0.005 * random.normal3());
    if (i % 5 == 0)
      log.poses.push_back(
          {log.time_s.back(), 5e-5 * random.normal3(), math::rotation(5e-4 * random.normal3())});
  }
  return log;
}

// Lever arm and yaw are free then. Full steps of the fit would go so far along them that it refuses poses.
TEST(FlightCalibration, RefusesNoPoseOfAVehicleThatStands) {
  for (const std::uint64_t seed : {4, 9, 16, 19, 53}) {
    const BodyAlignment found = align_body(standing(seed), {});
    EXPECT_EQ(found.refused, 0U) << seed;
    for (int i = 0; i < 2; ++i)
      EXPECT_LT(std::abs(found.misalignment.value[i]), 4.0 * found.misalignment.deviation[i]) << seed;
  }
}

TEST(FlightCalibration, RefusesPosesOfAnotherMotion) {
  const LaunchConfiguration plan = flight_of("calibration");
  FlightLog log = analysis::flown(plan, plan.vehicle, 1);
  for (identification::FlightPose& pose : log.poses)
    pose.position_ned = {pose.position_ned.y(), -pose.position_ned.x(), pose.position_ned.z()};
  EXPECT_TRUE(tests::contains({tests::refused<std::runtime_error>([&] { align_body(log, {}); })},
                              "do not show one motion"));
  log.poses.resize(100);
  EXPECT_TRUE(
      tests::contains({tests::refused<std::runtime_error>([&] { align_body(log, {}); })}, "are needed"));
}

EstimatedVector estimate(const Vector3d& value, const Vector3d& deviation) { return {value, deviation}; }

// The new values put the vehicle where it is, from the pose of the body.
TEST(FlightCalibration, AddsToWhatTheRoomFileHas) {
  mocap::VehicleBody before;
  before.misalignment = {0.1, -0.2, 0.3};
  before.lever_arm_frd = {0.05, 0.01, -0.02};
  BodyAlignment found;
  found.misalignment = estimate({0.01, 0.02, -0.03}, Vector3d::Constant(1e-3));
  found.lever_arm = estimate({0.004, -0.003, 0.002}, Vector3d::Constant(1e-3));
  const FlightCalibration after = calibrated(before, found);
  const Eigen::Quaterniond body = math::rotation({0.4, -0.3, 1.0});
  const Eigen::Quaterniond reported = body * math::rotation(before.misalignment);
  const Eigen::Quaterniond attitude = reported * math::rotation(found.misalignment.value);
  const Vector3d centre = reported * before.lever_arm_frd + attitude * found.lever_arm.value;
  const Eigen::Quaterniond now = body * math::rotation(after.misalignment.vector);
  EXPECT_LT(now.angularDistance(attitude), 1e-9);
  EXPECT_LT((now * after.lever_arm.frd - centre).norm(), 1e-12);
  EXPECT_TRUE(after.advice.empty());
}

TEST(FlightCalibration, KeepsWhatWasNotTold) {
  mocap::VehicleBody before;
  before.lever_arm_frd = {0.05, 0.01, -0.02};
  BodyAlignment found;
  found.misalignment = estimate({0.01, 0.02, -0.03}, {1e-3, 1e-3, 0.1});
  found.lever_arm = estimate({0.1, 0.2, 0.3}, Vector3d::Constant(0.02));
  const FlightCalibration after = calibrated(before, found);
  EXPECT_NEAR(after.misalignment.vector.z(), 0.0, 1e-9);
  EXPECT_NEAR(after.lever_arm.frd.norm(), before.lever_arm_frd.norm(), 1e-12);
  ASSERT_EQ(after.advice.size(), 4U);
  EXPECT_TRUE(tests::contains(after.advice, "misalignment about down is known to 100.0 mrad only"));
  found.misalignment.deviation.setConstant(0.2);
  EXPECT_TRUE(tests::contains({tests::refused<std::runtime_error>([&] { calibrated(before, found); })},
                              "the flight tells nothing"));
}

}  // namespace swiftlet::ground::flight_calibration_test

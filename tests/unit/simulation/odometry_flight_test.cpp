// Flights of a vehicle that brings an estimate of its own in place of IMU samples, in one process.
#include <algorithm>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "swiftlet/math/euler.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/unit/simulation/default_flight.hpp"

namespace swiftlet::simulation::odometry_flight_test {

using control::Mode;
using control::OdometryUse;
using plant::ControlLevel;
using plant::OdometrySource;

class Odometry : public DefaultFlight {
 protected:
  Odometry() {
    world_.control_levels = ControlLevel::kAttitude;
    world_.odometry.source = OdometrySource::kMocap;
  }

  // The fastest true motion within this time.
  struct Fastest {
    double speed = 0.0;     // m/s
    double yaw_rate = 0.0;  // rad/s
    double tilt_rad = 0.0;
  };
  static Fastest fastest(ClosedLoop& loop, double duration_s) {
    Fastest found;
    const double end_s = loop.time_s() + duration_s;
    loop.step_until(
        [&] {
          const plant::VehicleState& state = loop.plant.state();
          found.speed = std::max(found.speed, state.velocity_ned.norm());
          found.yaw_rate = std::max(found.yaw_rate, std::abs(state.body_rates_frd.z()));
          const math::EulerAngles angles = math::euler_angles(state.q_ned_from_frd);
          found.tilt_rad = std::max({found.tilt_rad, std::abs(angles.roll_rad), std::abs(angles.pitch_rad)});
          return loop.time_s() >= end_s;
        },
        duration_s + 1.0);
    return found;
  }
  void jump(double at_s, const Eigen::Vector3d& position_ned, double yaw_rad) {
    plant::Fault fault;
    fault.kind = plant::FaultKind::kOdometryJump;
    fault.at_s = at_s;
    fault.for_s = 100.0;
    fault.position_ned = position_ned;
    fault.yaw_rad = yaw_rad;
    world_.faults.push_back(fault);
  }
  void lose_mocap(double at_s, double for_s) {
    plant::Fault fault;
    fault.kind = plant::FaultKind::kMocapStop;
    fault.at_s = at_s;
    fault.for_s = for_s;
    world_.faults.push_back(fault);
  }
  static const control::OdometryStatus& odometry(const ClosedLoop& loop) {
    return loop.controller.status().odometry;
  }
};

class OdometrySquare : public Odometry,
                       public testing::WithParamInterface<std::tuple<ControlLevel, OdometryUse>> {};

TEST_P(OdometrySquare, IsTracked) {
  const auto [level, use] = GetParam();
  world_.control_levels = level;
  settings_.estimator.odometry.use = use;
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  const record::TrackingErrors errors = fly_square(loop, settings_);
  EXPECT_EQ(plant::level_of(loop.sent), level);
  EXPECT_LT(errors.rms_3d_m, 0.01);
  EXPECT_EQ(odometry(loop).in_force, use == OdometryUse::kVehicle);
  RecordProperty("rms_mm", std::to_string(1e3 * errors.rms_3d_m));
}

INSTANTIATE_TEST_SUITE_P(LevelsAndSettings, OdometrySquare,
                         testing::Combine(testing::Values(ControlLevel::kRates, ControlLevel::kAttitude,
                                                          ControlLevel::kTrajectory),
                                          testing::Values(OdometryUse::kMocap, OdometryUse::kVehicle)),
                         [](const auto& test) {
                           const bool own = std::get<1>(test.param) == OdometryUse::kVehicle;
                           return std::string(plant::to_string(std::get<0>(test.param))) +
                                  (own ? "_vehicle" : "_mocap");
                         });

// GIVEN a vehicle whose own frame drifts away from that of motion capture WHEN it flies the square by motion capture THEN its loops
// are commanded in their own frame, so that the drift does not show.
class OdometryDrift : public Odometry, public testing::WithParamInterface<ControlLevel> {};

TEST_P(OdometryDrift, DoesNotShowInTheSquare) {
  world_.control_levels = GetParam();
  world_.odometry.source = OdometrySource::kOwnSensors;
  world_.odometry.position_drift_m = 0.5;
  world_.odometry.heading_drift_rad = 0.2;
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  const record::TrackingErrors errors = fly_square(loop, settings_);
  EXPECT_LT(errors.rms_3d_m, 0.02);
  RecordProperty("rms_mm", std::to_string(1e3 * errors.rms_3d_m));
}

INSTANTIATE_TEST_SUITE_P(Levels, OdometryDrift,
                         testing::Values(ControlLevel::kRates, ControlLevel::kAttitude,
                                         ControlLevel::kTrajectory),
                         [](const auto& test) { return std::string(plant::to_string(test.param)); });

TEST_F(Odometry, LevelActuatorsNeedsAnImu) {
  world_.control_levels = ControlLevel::kActuators;
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  run(loop, 1.0);
  control::Request request;
  request.kind = control::RequestKind::kArm;
  EXPECT_STREQ(loop.controller.request(request).reason,
               "cannot arm: level actuators needs imu, but the vehicle brings vehicle_odometry");
}

TEST_F(Odometry, ThatStopsStopsTheRotorsAsASilentImuDoes) {
  plant::Fault fault;
  fault.kind = plant::FaultKind::kImuStop;
  fault.at_s = 8.0;
  fault.for_s = 0.4;
  world_.faults = {fault};
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  ASSERT_TRUE(loop.step_until([&] { return mode(loop) == Mode::kStopped; }, 5.0));
  EXPECT_EQ(loop.controller.status().reason, control::Reason::kImuGap);
}

TEST_F(Odometry, StepsWithoutAllocation) {
  settings_.estimator.odometry.use = OdometryUse::kBoth;
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  const test::MallocGuard guard;
  run(loop, 0.5);
  EXPECT_EQ(guard.calls(), 0U);
}

// With sensors of its own, whose position drifts, and a jump of 0.5 m and 0.3 rad.
class OdometryFaults : public Odometry, public testing::WithParamInterface<OdometryUse> {
 protected:
  OdometryFaults() {
    world_.odometry.source = OdometrySource::kOwnSensors;
    settings_.estimator.odometry.use = GetParam();
  }
};

TEST_P(OdometryFaults, AJumpIsNoKick) {
  for (const ControlLevel level :
       {ControlLevel::kRates, ControlLevel::kAttitude, ControlLevel::kTrajectory}) {
    SCOPED_TRACE(plant::to_string(level));
    world_.control_levels = level;
    world_.faults.clear();
    jump(9.0, {0.4, -0.3, 0.0}, 0.3);
    ClosedLoop loop(vehicle_, world_, settings_, 1);
    hover(loop);
    ASSERT_LT(loop.time_s(), 9.0);
    run(loop, 8.999 - loop.time_s());
    const Eigen::Vector3d before_ned = loop.plant.state().position_ned;
    const Fastest found = fastest(loop, 8.0);
    EXPECT_EQ(mode(loop), Mode::kHolding);
    EXPECT_EQ(odometry(loop).resets, 1U);
    EXPECT_LT(found.speed, GetParam() == OdometryUse::kVehicle ? 0.25 : 0.05) << "glides at 0.2 m/s";
    EXPECT_LT(found.yaw_rate, GetParam() == OdometryUse::kVehicle ? 0.3 : 0.1) << "glides at 0.2 rad/s";
    EXPECT_LT(found.tilt_rad, 0.1);
    const double moved_m = (loop.plant.state().position_ned - before_ned).norm();
    if (GetParam() == OdometryUse::kVehicle) {
      EXPECT_NEAR(moved_m, 0.5, 0.25) << "it goes to where it now knows its place";
    } else {
      EXPECT_LT(moved_m, 0.05);
    }
    RecordProperty(std::string(plant::to_string(level)) + "_fastest",
                   std::to_string(found.speed) + " m/s " + std::to_string(found.yaw_rate) + " rad/s");
  }
}

TEST_P(OdometryFaults, MotionCaptureIsLostForTenSeconds) {
  lose_mocap(9.0, 10.0);
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  run(loop, 9.0 - loop.time_s());
  const Eigen::Vector3d before_ned = loop.plant.state().position_ned;
  const Fastest lost = fastest(loop, 9.9);
  if (GetParam() == OdometryUse::kMocap) {
    EXPECT_NE(mode(loop), Mode::kHolding);
    EXPECT_TRUE(loop.plant.on_ground()) << "it descends level";
    return;
  }
  EXPECT_EQ(mode(loop), Mode::kHolding);
  EXPECT_TRUE(odometry(loop).in_force);
  EXPECT_LT((loop.plant.state().position_ned - before_ned).norm(), 0.25) << "as its own estimate drifts";
  EXPECT_LT(lost.speed, 0.1);
  const Fastest back = fastest(loop, 5.0);
  EXPECT_EQ(mode(loop), Mode::kHolding);
  EXPECT_EQ(odometry(loop).in_force, GetParam() == OdometryUse::kVehicle);
  EXPECT_LT(back.speed, 0.25) << "glides back at 0.2 m/s";
  if (GetParam() == OdometryUse::kBoth) {
    EXPECT_LT((loop.plant.state().position_ned - before_ned).norm(), 0.02);
  }
  RecordProperty("fastest", std::to_string(lost.speed) + " m/s, then " + std::to_string(back.speed) + " m/s");
}

// GIVEN an own estimate that the vehicle makes from our poses WHEN these end THEN it is as lost as ours is, whatever the setting,
// although the vehicle goes on to call its position valid.
TEST_P(OdometryFaults, MadeFromMotionCaptureIsLostWithIt) {
  world_.odometry.source = OdometrySource::kMocap;
  lose_mocap(9.0, 10.0);
  ClosedLoop loop(vehicle_, world_, settings_, 1);
  hover(loop);
  run(loop, 8.99 - loop.time_s());
  ASSERT_EQ(mode(loop), Mode::kHolding);
  run(loop, settings_.failsafe.mocap_timeout_s + 0.1);
  EXPECT_EQ(mode(loop), Mode::kDescent);
  EXPECT_FALSE(loop.controller.status().has_pose);
  EXPECT_EQ(odometry(loop).in_force, GetParam() == OdometryUse::kVehicle);
  ASSERT_TRUE(loop.step_until([&] { return mode(loop) == Mode::kDisarmed; }, 9.0));
  EXPECT_TRUE(loop.plant.on_ground());
}

INSTANTIATE_TEST_SUITE_P(Settings, OdometryFaults,
                         testing::Values(OdometryUse::kMocap, OdometryUse::kVehicle, OdometryUse::kBoth),
                         [](const auto& test) {
                           return test.param == OdometryUse::kMocap     ? "mocap"
                                  : test.param == OdometryUse::kVehicle ? "vehicle"
                                                                        : "both";
                         });

}  // namespace swiftlet::simulation::odometry_flight_test

// The estimator in the closed loop: simulated vehicle, all sensor models, flight controller.
#include <algorithm>
#include <cstdint>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::estimator_flight_test {

using Eigen::Vector3d;
using simulation::ClosedLoop;

const std::string kConfig = tests::in_source("config/");

plant::SimulationSettings world(const std::string& name) {
  return io::load_simulation_settings(kConfig + "simulation/" + name + ".yaml");
}

// The timeout of poses is long enough for half a second of dead reckoning.
ClosedLoop loop(const plant::SimulationSettings& simulation, std::uint64_t seed) {
  ControlSettings settings = io::load_control_settings(kConfig + "control/motor_lag.yaml");
  settings.failsafe.mocap_timeout_s = 0.6;
  return {io::load_vehicle(kConfig + "vehicles/kaylion.yaml"), simulation, settings, seed};
}

Request request(RequestKind kind, const Vector3d& position_ned = Vector3d::Zero()) {
  Request out;
  out.kind = kind;
  out.position_ned = position_ned;
  out.speed = 0.5;
  return out;
}

void pass(ClosedLoop& flown, double time_s) {
  const double end = flown.time_s() + time_s;
  flown.step_until([&] { return flown.time_s() >= end; }, 2.0 * time_s);
}

void hover(ClosedLoop& flown) {
  pass(flown, 0.5);
  ASSERT_TRUE(flown.controller.request(request(RequestKind::kArm)).accepted);
  ASSERT_TRUE(flown.controller.request(request(RequestKind::kTakeoff, {0, 0, -1})).accepted);
  ASSERT_TRUE(flown.step_until([&] { return flown.controller.status().mode == Mode::kHolding; }, 10.0));
  pass(flown, 3.0);
}

TEST(EstimatorInFlight, DriftsLessThanTenCentimetresInHalfASecondWithoutPoses) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    ClosedLoop flown = loop(world("default"), seed);
    hover(flown);
    const Vector3d before = flown.plant.state().position_ned;
    flown.mocap_connected = false;
    double estimate_error = 0.0;
    double drift = 0.0;
    const double end = flown.time_s() + 0.5;
    while (flown.time_s() < end) {
      flown.step();
      const Vector3d position = flown.plant.state().position_ned;
      estimate_error = std::max(estimate_error, (flown.controller.estimate().position_ned - position).norm());
      drift = std::max(drift, (position - before).norm());
    }
    EXPECT_LT(estimate_error, 0.10) << "seed " << seed;
    EXPECT_LT(drift, 0.10) << "seed " << seed;
    EXPECT_GT(flown.controller.estimate_deviation().head<3>().maxCoeff(), 2e-4) << "seed " << seed;
    EXPECT_EQ(flown.controller.status().mode, Mode::kHolding);
    flown.mocap_connected = true;
    pass(flown, 1.0);
    EXPECT_EQ(flown.controller.estimate().resets, 0U) << "seed " << seed;
    EXPECT_LT(flown.tracking_error().norm(), 0.05) << "seed " << seed;
  }
}

// Take-off, a move and a turn. If the sign flips, every third pose has -q instead of q.
Vector3d fly_with_signs(bool flips) {
  ClosedLoop flown = loop(world("default"), 7);
  const auto step_for = [&](double time_s) {
    const double end = flown.time_s() + time_s;
    while (flown.time_s() < end) {
      do {
        flown.plant.step(flown.firmware.motor_command(flown.plant.stamp_ns()));
      } while (!flown.plant.imu());
      auto pose = flown.mocap.update(flown.plant.truth());
      if (pose && flips && pose->sequence % 3 == 0) pose->q_ned_from_frd.coeffs() *= -1.0;
      if (pose) flown.controller.on_pose(*pose);
      if (flown.plant.battery()) flown.controller.on_battery(*flown.plant.battery());
      if (flown.plant.rotor_speeds()) flown.controller.on_rotor_speeds(*flown.plant.rotor_speeds());
      flown.command = std::get<plant::ActuatorCommand>(flown.controller.on_imu(*flown.plant.imu()));
      flown.firmware.accept(flown.command, flown.plant.stamp_ns());
    }
  };
  step_for(0.5);
  EXPECT_TRUE(flown.controller.request(request(RequestKind::kArm)).accepted);
  EXPECT_TRUE(flown.controller.request(request(RequestKind::kTakeoff, {0, 0, -1})).accepted);
  step_for(6.0);
  Request turn = request(RequestKind::kGoTo, {0.5, 0.3, -1.2});
  turn.yaw_free = false;
  turn.yaw_rad = 3.0;  // q.w is near 0: either sign is likely
  EXPECT_TRUE(flown.controller.request(turn).accepted);
  step_for(5.0);
  EXPECT_EQ(flown.controller.status().mode, Mode::kHolding);
  EXPECT_EQ(flown.controller.estimate().poses_refused, 0U);
  EXPECT_LT((flown.plant.state().position_ned - Vector3d(0.5, 0.3, -1.2)).norm(), 0.02);
  return flown.plant.state().position_ned;
}

TEST(EstimatorInFlight, IgnoresTheSignOfTheQuaternion) {
  EXPECT_LT((fly_with_signs(true) - fly_with_signs(false)).norm(), 1e-6);
}

TEST(EstimatorInFlight, AcceptsEveryPoseOfEveryWorld) {
  for (const char* name : {"default", "ideal", "optitrack"}) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
      ClosedLoop flown = loop(world(name), seed);
      hover(flown);
      const std::uint64_t refused = flown.controller.estimate().poses_refused;  // before the first IMU sample
      ASSERT_TRUE(flown.controller.request(request(RequestKind::kGoTo, {1.5, -1.0, -1.5})).accepted);
      pass(flown, 8.0);
      EXPECT_EQ(flown.controller.estimate().poses_refused, refused) << name << ", seed " << seed;
      EXPECT_LE(refused, 2U) << name << ", seed " << seed;
      EXPECT_EQ(flown.controller.estimate().resets, 0U);
      EXPECT_LT(flown.tracking_error().norm(), 0.02) << name << ", seed " << seed;
    }
  }
}

class Latency : public testing::TestWithParam<double> {};

TEST_P(Latency, OfPosesKeepsTheLoopStable) {
  plant::SimulationSettings simulation = world("default");
  simulation.mocap.latency_s = GetParam();
  ClosedLoop flown = loop(simulation, 1);
  hover(flown);
  double worst = 0.0;
  for (const Vector3d& corner : {Vector3d(1, 0, -1), Vector3d(1, 1, -1), Vector3d(0, 1, -1)}) {
    ASSERT_TRUE(flown.controller.request(request(RequestKind::kGoTo, corner)).accepted);
    const double end = flown.time_s() + 5.0;
    while (flown.time_s() < end) {
      flown.step();
      worst = std::max(worst, flown.tracking_error().norm());
    }
  }
  EXPECT_LT(worst, 0.02);
  EXPECT_EQ(flown.controller.status().mode, Mode::kHolding);
}
INSTANTIATE_TEST_SUITE_P(Seconds, Latency, testing::Values(0.0, 0.01, 0.03, 0.1));

}  // namespace swiftlet::control::estimator_flight_test

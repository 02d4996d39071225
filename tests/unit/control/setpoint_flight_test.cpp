// Setpoint streams on the whole vehicle, with all sensor models on.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::setpoint_flight_test {

using Eigen::Vector3d;

constexpr double kPeriod_s = 0.02;

class SetpointFlight : public testing::TestWithParam<const char*> {
 protected:
  static ControlSettings settings() {
    return io::load_control_settings(tests::in_source("config/control/") + std::string(GetParam()) + ".yaml");
  }

  void SetUp() override {
    loop_.step_until([&] { return loop_.time_s() > 0.5; }, 1.0);
    ASSERT_TRUE(ask(RequestKind::kArm));
    ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1.2}));
    ASSERT_TRUE(loop_.step_until([&] { return mode() == Mode::kHolding; }, 10.0));
    const double now_s = loop_.time_s();
    loop_.step_until([&] { return loop_.time_s() > now_s + 2.0; }, 3.0);
  }
  bool ask(RequestKind kind, const Vector3d& position = Vector3d::Zero()) {
    Request request;
    request.kind = kind;
    request.position_ned = position;
    return loop_.controller.request(request).accepted;
  }
  Mode mode() const { return loop_.controller.status().mode; }
  const plant::VehicleState& truth() const { return loop_.plant.state(); }
  double tilt_rad() const { return std::acos(cosine_of_tilt(truth().q_ned_from_frd)); }

  // Streams for a duration, or until a setpoint is refused.
  Outcome stream(const Setpoint& setpoint, double duration_s) {
    const double end_s = loop_.time_s() + duration_s;
    Outcome outcome;
    double next_s = loop_.time_s();
    while (loop_.time_s() < end_s) {
      if (loop_.time_s() >= next_s) {
        next_s += kPeriod_s;
        outcome = loop_.controller.on_setpoint(setpoint);
        if (!outcome.accepted) break;
      }
      loop_.step();
    }
    return outcome;
  }
  Setpoint attitude(double roll_rad, double pitch_rad, double yaw_rad) {
    Setpoint setpoint;
    setpoint.kind = SetpointKind::kAttitude;
    setpoint.q_ned_from_frd = math::quaternion_from_euler({roll_rad, pitch_rad, yaw_rad});
    setpoint.specific_thrust = plant::kGravity / (std::cos(roll_rad) * std::cos(pitch_rad));
    return setpoint;
  }
  Setpoint body_rates(const Vector3d& rates) {
    Setpoint setpoint;
    setpoint.kind = SetpointKind::kBodyRates;
    setpoint.body_rates_frd = rates;
    setpoint.specific_thrust = plant::kGravity;
    return setpoint;
  }

  simulation::ClosedLoop loop_{io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")),
                               plant::SimulationSettings(), settings(), 11};
};

TEST_P(SetpointFlight, FollowsAnAttitudeAndKeepsItsHeight) {
  ASSERT_TRUE(stream(attitude(0.1, -0.05, 0.0), 0.8).accepted);
  EXPECT_EQ(mode(), Mode::kSetpoint);
  const Vector3d euler = math::euler_angles(truth().q_ned_from_frd).vector();
  EXPECT_NEAR(euler.x(), 0.1, 0.02);
  EXPECT_NEAR(euler.y(), -0.05, 0.02);
  EXPECT_NEAR(truth().position_ned.z(), -1.2, 0.1);
  EXPECT_GT(truth().velocity_ned.y(), 0.3) << "rolled right, it flies east";
  ASSERT_TRUE(loop_.step_until([&] { return mode() == Mode::kHolding; }, 1.0));
  EXPECT_EQ(loop_.controller.status().reason, Reason::kSetpointsStopped);
  const auto rests = [&] { return truth().velocity_ned.norm() < 0.02; };
  EXPECT_TRUE(loop_.step_until(rests, 10.0));
}

TEST_P(SetpointFlight, FollowsBodyRates) {
  const double before = math::euler_angles(truth().q_ned_from_frd).vector().z();
  ASSERT_TRUE(stream(body_rates({0, 0, 1.0}), 1.5).accepted);
  EXPECT_NEAR(truth().body_rates_frd.z(), 1.0, 0.1);
  EXPECT_NEAR(math::wrap_angle(math::euler_angles(truth().q_ned_from_frd).vector().z() - before), 1.5, 0.4);
  EXPECT_LT(tilt_rad(), 0.1);
  ASSERT_TRUE(stream(body_rates({0.5, 0, 0}), 0.3).accepted);
  EXPECT_NEAR(truth().body_rates_frd.x(), 0.5, 0.1);
}

TEST_P(SetpointFlight, StopsTheRotorsWhenBodyRatesTipItOver) {
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -2.3}));  // high enough to tip over before it must stop sinking
  loop_.step_until([&] { return truth().position_ned.z() < -2.29; }, 6.0);
  stream(body_rates({4.0, 0, 0}), 1.0);
  EXPECT_EQ(mode(), Mode::kStopped);
  EXPECT_EQ(loop_.controller.status().reason, Reason::kTippedOver);
}

TEST_P(SetpointFlight, StopsAnAttitudeStreamInsideTheFenceUntilARequest) {
  double farthest_m = 0.0;
  stream(attitude(0.2, 0.0, 0.0), 10.0);
  EXPECT_EQ(mode(), Mode::kHolding);
  EXPECT_EQ(loop_.controller.status().reason, Reason::kSetpointsViolatedFence);
  loop_.step_until(
      [&] {
        farthest_m = std::max(farthest_m, truth().position_ned.y());
        return false;
      },
      5.0);
  EXPECT_LT(farthest_m, 3.0);
  EXPECT_GT(farthest_m, 1.5);
  EXPECT_EQ(mode(), Mode::kHolding);
  const Setpoint level = attitude(0.0, 0.0, 0.0);
  EXPECT_STREQ(
      loop_.controller.on_setpoint(level).reason,
      "setpoint: the stream violated the fence; send hold or goto before more setpoints of its kind");
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1.2}));
  EXPECT_TRUE(loop_.controller.on_setpoint(level).accepted);
}

// From a tilted attitude to a velocity the tilt changes without a jump.
TEST_P(SetpointFlight, ChangesFromAttitudeToVelocityWithoutAJump) {
  ASSERT_TRUE(stream(attitude(0.15, 0.0, 0.0), 0.8).accepted);
  const Vector3d before = loop_.controller.attitude_setpoint().body_z_ned;
  Setpoint velocity;
  velocity.kind = SetpointKind::kVelocity;
  velocity.velocity_ned = {0, 0.5, 0};
  velocity.yaw_free = true;
  ASSERT_TRUE(loop_.controller.on_setpoint(velocity).accepted);
  loop_.step();
  const Vector3d after = loop_.controller.attitude_setpoint().body_z_ned;
  EXPECT_LT(std::acos(std::min(before.dot(after), 1.0)), 0.08);
  ASSERT_TRUE(stream(velocity, 2.0).accepted);
  EXPECT_NEAR(truth().velocity_ned.y(), 0.5, 0.1);
}

TEST_P(SetpointFlight, FliesAPositionStreamOf2HzSmoothly) {
  double most_rate = 0.0, most_tilt = 0.0;
  Setpoint setpoint;
  setpoint.yaw_free = true;
  setpoint.position_ned = {0, 0, -1.2};
  for (int i = 1; i <= 12; ++i) {
    setpoint.position_ned.x() = 0.15 * std::min(i, 10);
    ASSERT_TRUE(loop_.controller.on_setpoint(setpoint).accepted);
    const double end_s = loop_.time_s() + 0.5;
    while (loop_.time_s() < end_s) {
      loop_.step();
      most_rate = std::max(most_rate, truth().body_rates_frd.norm());
      most_tilt = std::max(most_tilt, tilt_rad());
    }
  }
  EXPECT_EQ(mode(), Mode::kSetpoint);
  EXPECT_LT(most_tilt, 0.25) << "2 m/s^2 tilt it by 0.2";
  EXPECT_LT(most_rate, 1.5);
  loop_.step_until([&] { return mode() == Mode::kHolding; }, 2.0);
  loop_.step_until([] { return false; }, 3.0);
  EXPECT_NEAR(truth().position_ned.x(), 1.5, 0.03);
}

// Positions that continue through the fence: the last accepted one leaves room to stop inside.
TEST_P(SetpointFlight, StopsAPositionStreamBeforeTheFence) {
  double farthest_reference_m = 0.0, farthest_m = 0.0;
  Setpoint setpoint;
  setpoint.yaw_free = true;
  setpoint.position_ned = {0, 0, -1.2};
  setpoint.velocity_ned = {0, 0.4, 0};
  const double start_s = loop_.time_s();
  const double start_y = loop_.controller.reference().position_ned.y();
  double next_s = start_s;
  while (loop_.time_s() < start_s + 12.0) {
    if (loop_.time_s() >= next_s) {
      next_s += kPeriod_s;
      setpoint.position_ned.y() = start_y + 0.4 * (loop_.time_s() - start_s);
      loop_.controller.on_setpoint(setpoint);
    }
    loop_.step();
    farthest_m = std::max(farthest_m, truth().position_ned.y());
    farthest_reference_m = std::max(farthest_reference_m, loop_.controller.reference().position_ned.y());
  }
  EXPECT_EQ(mode(), Mode::kHolding);
  EXPECT_LE(farthest_reference_m, 3.0);
  EXPECT_GT(farthest_reference_m, 2.9);
  const double lag_m = std::string(GetParam()) == "paper" ? 0.07 : 0.03;  // of the loops while it stops
  EXPECT_LT(farthest_m, 3.0 + lag_m);
}

TEST_P(SetpointFlight, AllocatesNoMemoryForAnyKind) {
  std::size_t calls = 0;
  Setpoint setpoint = attitude(0.02, 0.0, 0.0);
  setpoint.yaw_free = true;
  setpoint.position_ned = {0.1, 0.1, -1.2};
  setpoint.velocity_ned = {0.1, 0.0, 0.0};
  for (const SetpointKind kind :
       {SetpointKind::kPosition, SetpointKind::kVelocity, SetpointKind::kAcceleration,
        SetpointKind::kAttitude, SetpointKind::kBodyRates}) {
    setpoint.kind = kind;
    {
      const test::MallocGuard guard;
      EXPECT_TRUE(loop_.controller.on_setpoint(setpoint).accepted) << static_cast<int>(kind);
      calls += guard.calls();
    }
    for (int i = 0; i < 20; ++i) {
      do {
        loop_.plant.step(loop_.firmware.motor_command(loop_.plant.stamp_ns()));
      } while (!loop_.plant.imu());
      const auto pose = loop_.mocap.update(loop_.plant.truth());
      const test::MallocGuard guard;
      if (pose) loop_.controller.on_pose(*pose);
      loop_.command = std::get<plant::ActuatorCommand>(loop_.controller.on_imu(*loop_.plant.imu()));
      calls += guard.calls();
      loop_.firmware.accept(loop_.command, loop_.plant.stamp_ns());
    }
  }
  EXPECT_EQ(calls, 0U);
}

INSTANTIATE_TEST_SUITE_P(WithSettings, SetpointFlight, testing::Values("motor_lag", "paper"),
                         [](const auto& settings) { return std::string(settings.param); });

}  // namespace swiftlet::control::setpoint_flight_test

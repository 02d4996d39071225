// Changes of the gains in flight, with all sensor models on.
#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/io/settings/control_settings_file.hpp"
#include "swiftlet/io/settings/vehicle_file.hpp"
#include "swiftlet/simulation/closed_loop.hpp"
#include "tests/support/malloc_guard.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::control::gain_change_flight_test {

using Eigen::Vector3d;
using simulation::ClosedLoop;

plant::Vehicle kaylion() { return io::load_vehicle(tests::in_source("config/vehicles/kaylion.yaml")); }
ControlSettings motor_lag() {
  return io::load_control_settings(tests::in_source("config/control/motor_lag.yaml"));
}
// Half the bandwidth of the position loop, and a softer attitude.
ControlSettings soft() {
  ControlSettings settings = motor_lag();
  settings.name = "soft";
  settings.attitude.roll.q[0] = settings.attitude.pitch.q[0] = 20000.0;
  settings.position.x.omega_n = settings.position.y.omega_n = 1.0;
  settings.position.integral_limit = 1.0;
  return settings;
}
ControlGains gains_of(const ControlSettings& settings) {
  return control_gains(design(kaylion(), settings), settings);
}

class GainChangeInFlight : public testing::Test {
 protected:
  void SetUp() override {
    run(0.5);
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    ASSERT_TRUE(loop_.step_until([&] { return loop_.controller.status().mode == Mode::kHolding; }, 10.0));
    run(2.0);
  }
  void run(double time_s) {
    loop_.step_until([] { return false; }, time_s);
  }
  Outcome ask(RequestKind kind, const Vector3d& position_ned = Vector3d::Zero()) {
    Request request;
    request.key = {1, ++asked_};
    request.kind = kind;
    request.position_ned = position_ned;
    request.gains = &change_;
    return loop_.controller.request(request);
  }
  Outcome change_to(const ControlSettings& settings, double duration_s) {
    change_.from = loop_.controller.gains();
    change_.to = gains_of(settings);
    change_.name = settings_name(settings.name);
    change_.duration_s = duration_s;
    return ask(RequestKind::kSettings);
  }
  const RequestStatus& last() const { return loop_.controller.requests().back(); }

  ClosedLoop loop_{kaylion(), plant::SimulationSettings(), motor_lag(), 5};
  GainChange change_;
  std::uint64_t asked_ = 0;
};

TEST_F(GainChangeInFlight, ReachesTheNewGainsWithoutAStep) {
  ASSERT_TRUE(change_to(soft(), 1.0).accepted);
  run(0.002);
  double thrust_n = loop_.controller.attitude_setpoint().thrust_n;
  double thrust_step_n = 0.0;
  double deviation_m = 0.0;
  double progress = 0.0;
  loop_.step_until(
      [&] {
        const double now_n = loop_.controller.attitude_setpoint().thrust_n;
        thrust_step_n = std::max(thrust_step_n, std::abs(now_n - thrust_n));
        thrust_n = now_n;
        deviation_m = std::max(deviation_m, (loop_.plant.state().position_ned - Vector3d(0, 0, -1)).norm());
        EXPECT_GE(loop_.controller.status().gains_progress, progress);
        progress = loop_.controller.status().gains_progress;
        return false;
      },
      0.988);
  EXPECT_EQ(last().state, RequestState::kExecuting);
  EXPECT_NEAR(last().progress, 0.99, 0.01);
  run(0.05);
  EXPECT_EQ(last().state, RequestState::kSucceeded);
  EXPECT_EQ(loop_.controller.gains(), gains_of(soft()));
  EXPECT_STREQ(loop_.controller.status().settings.data(), "soft");
  EXPECT_EQ(loop_.controller.status().mode, Mode::kHolding);
  EXPECT_LT(deviation_m, 0.02);
  EXPECT_LT(thrust_step_n, 0.05 * kaylion().mass_kg * plant::kGravity);
}

TEST_F(GainChangeInFlight, DoesNotCancelOtherRequests) {
  ASSERT_TRUE(ask(RequestKind::kGoTo, {1, 0, -1}).accepted);
  run(0.2);
  ASSERT_TRUE(change_to(soft(), 0.5).accepted);
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  run(4.0);
  int succeeded = 0;
  for (const RequestStatus& request : loop_.controller.requests())
    if (request.kind == RequestKind::kSettings || request.kind == RequestKind::kHold)
      succeeded += static_cast<int>(request.state == RequestState::kSucceeded);
  EXPECT_EQ(succeeded, 2);
}

TEST_F(GainChangeInFlight, IsRefusedDuringAnotherChange) {
  ASSERT_TRUE(change_to(soft(), 2.0).accepted);
  run(0.5);
  EXPECT_STREQ(change_to(motor_lag(), 2.0).reason, "the gains are still changing, for another 1.5 s");
  run(1.6);
  EXPECT_TRUE(change_to(motor_lag(), 2.0).accepted);
}

TEST_F(GainChangeInFlight, HasEndedAlsoForAVehicleThatWasRestarted) {
  ASSERT_TRUE(change_to(soft(), 0.5).accepted);
  run(0.6);
  ASSERT_TRUE(ask(RequestKind::kStop).accepted);
  run(0.01);
  plant::ImuSample first = *loop_.plant.imu();
  first.stamp_ns = 2'000'000;
  loop_.controller.on_imu(first);
  EXPECT_EQ(loop_.controller.status().gains_progress, 1.0);
  EXPECT_EQ(loop_.controller.gains(), gains_of(soft()));
}

TEST_F(GainChangeInFlight, IsRefusedFromGainsThatAreNotInForce) {
  ASSERT_TRUE(change_to(soft(), 0.5).accepted);
  run(0.6);
  change_.from = gains_of(motor_lag());
  EXPECT_STREQ(ask(RequestKind::kSettings).reason,
               "another request changed the gains meanwhile; send this one again");
}

TEST_F(GainChangeInFlight, IsRefusedWhileLanding) {
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  run(0.1);
  EXPECT_STREQ(change_to(soft(), 2.0).reason, "cannot change the gains while landing");
}

TEST_F(GainChangeInFlight, TakesEffectAtOnceOnTheGround) {
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(loop_.step_until([&] { return loop_.controller.status().mode == Mode::kDisarmed; }, 20.0));
  ASSERT_TRUE(change_to(soft(), 60.0).accepted);
  EXPECT_EQ(last().state, RequestState::kSucceeded);
  run(0.01);
  EXPECT_EQ(loop_.controller.gains(), gains_of(soft()));
}

// GIVEN a change half way, WHEN another controller adopts the state, THEN it flies with the same gains at
// every later time and ends with the new ones.
TEST_F(GainChangeInFlight, IsContinuedByAStandby) {
  ASSERT_TRUE(change_to(soft(), 2.0).accepted);
  run(1.0);
  const FlightState state = loop_.controller.state();
  loop_.controller = FlightController(kaylion(), motor_lag());
  ASSERT_TRUE(loop_.step_until([&] { return loop_.controller.status().has_pose; }, 0.1));
  loop_.controller.adopt(state, nullptr, nullptr);
  run(0.002);
  const ControlGains adopted = loop_.controller.gains();
  EXPECT_LT(std::abs(adopted.position_p.x() -
                     0.5 * (gains_of(soft()).position_p.x() + gains_of(motor_lag()).position_p.x())),
            0.05);
  EXPECT_STREQ(loop_.controller.status().settings.data(), "soft");
  run(1.1);
  EXPECT_EQ(loop_.controller.gains(), gains_of(soft()));
}

TEST_F(GainChangeInFlight, DoesNotAllocate) {
  ASSERT_TRUE(change_to(soft(), 1.0).accepted);
  plant::ImuSample sample;
  sample.stamp_ns = loop_.controller.estimate().stamp_ns;
  sample.specific_force_frd = {0.0, 0.0, -plant::kGravity};
  const test::MallocGuard guard;
  for (int i = 0; i < 50; ++i) {
    sample.stamp_ns += 2'000'000;
    ++sample.sequence;
    loop_.controller.on_imu(sample);
  }
  EXPECT_EQ(guard.calls(), 0U);
}

}  // namespace swiftlet::control::gain_change_flight_test

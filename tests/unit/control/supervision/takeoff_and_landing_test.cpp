// From the ground and back to it.
#include <functional>

#include <gtest/gtest.h>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::takeoff_and_landing_test {

using tests::SupervisedFlight;

class TakeoffAndLanding : public tests::FlightTest {};

TEST_F(TakeoffAndLanding, TakesOffHoldsAndLands) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  step();
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kIdle);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  step();
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kSpoolUp);
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_NEAR(estimate_.position_ned.z(), -1.0, 1e-9);
  EXPECT_TRUE(supervisor_.airborne());
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kLanded);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
  EXPECT_FALSE(supervisor_.airborne());
}

// On the ground the contact force would wind up the integrals.
TEST_F(TakeoffAndLanding, IntegratesInTheAirOnly) {
  const auto check_at_height = [&] {
    const double height_m = -estimate_.position_ned.z();
    if (height_m < 0.01 || height_m > 0.2) {
      EXPECT_EQ(control_setpoint_.integrate, height_m > 0.2) << height_m << " m";
    }
  };
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  const auto flies_until = [&](Mode mode) {
    return step_until(
        [&] {
          check_at_height();
          return supervisor_.mode() == mode;
        },
        20.0);
  };
  ASSERT_TRUE(flies_until(Mode::kHolding));
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(flies_until(Mode::kDisarmed));
}

// A push at the end of a landing, while the rotors still carry nearly the weight.
TEST_F(TakeoffAndLanding, DetectsLandingWhileSliding) {
  for (const double height_m : {0.0, 0.3}) {
    SupervisedFlight flight;
    ASSERT_TRUE(flight.take_off());
    ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
    ASSERT_TRUE(
        flight.step_until([&] { return flight.estimate_.position_ned.z() > -height_m - 0.02; }, 10.0));
    flight.follows_ = false;
    flight.estimate_.velocity_ned = {0.3, 0.0, 0.0};
    EXPECT_EQ(flight.step_until(Mode::kDisarmed, 3.0), height_m == 0.0) << height_m;
  }
}

TEST_F(TakeoffAndLanding, LandingRequestedNearTheGroundDoesNotRise) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.z() > -0.01; }, 10.0));
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  const double before_z = control_setpoint_.reference.position_ned.z();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  while (supervisor_.mode() == Mode::kLanding) {
    step();
    ASSERT_GT(control_setpoint_.reference.position_ned.z(), before_z - 0.02);
  }
  EXPECT_EQ(supervisor_.reason(), Reason::kLanded);
}

// GIVEN a take-off whose lift-off is observed WHEN the vehicle has left the ground THEN nothing stops its rotors as
// on the ground.
TEST_F(TakeoffAndLanding, IsInTheAirFromItsLiftOffOn) {
  const auto lift_off = [&](bool observed) {
    ASSERT_TRUE(ask(RequestKind::kStop).accepted);
    ASSERT_TRUE(ask(RequestKind::kDisarm).accepted);
    estimate_ = Estimate();
    inputs_.pose_age_s = inputs_.battery_age_s = 0.0;
    inputs_.lift_off_ns = kNoLiftOffYet;
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    for (int i = 0; i < 100; ++i) step();
    ASSERT_EQ(supervisor_.state().guidance.phase, Phase::kSpoolUp);
    if (!observed) return;
    inputs_.lift_off_ns = inputs_.stamp_ns;
    estimate_.position_ned.z() = -0.002;
    step();
    ASSERT_EQ(supervisor_.state().guidance.phase, Phase::kSpoolUp) << "until it is clear of the ground";
  };
  const auto outcome = [&](bool observed, const std::function<void()>& happens) {
    lift_off(observed);
    happens();
    step();
    return supervisor_.mode();
  };
  const auto disarm = [&] { ask(RequestKind::kDisarm); };
  EXPECT_EQ(outcome(false, disarm), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, disarm), Mode::kTakingOff);
  const auto land = [&] { EXPECT_TRUE(ask(RequestKind::kLand).accepted); };
  EXPECT_EQ(outcome(false, land), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, land), Mode::kLanding);
  const auto lose_pose = [&] { inputs_.pose_age_s = 10.0; };
  EXPECT_EQ(outcome(false, lose_pose), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, lose_pose), Mode::kDescent);
  const auto lose_battery = [&] { inputs_.battery_age_s = 10.0; };
  EXPECT_EQ(outcome(false, lose_battery), Mode::kDisarmed);
  EXPECT_EQ(outcome(true, lose_battery), Mode::kLanding);
  const auto hold = [&] { ask(RequestKind::kHold); };
  EXPECT_EQ(outcome(true, hold), Mode::kHolding);
  EXPECT_TRUE(step_until([&] { return estimate_.position_ned.z() < -0.05; }, 3.0)) << "at the minimum height";
}

// GIVEN a vehicle that never reports that its rotors run WHEN it is to take off THEN the take-off ends after 10 s with that reason, and one
// that reports it after 9 s takes off.
TEST_F(TakeoffAndLanding, TakeOffEndsIfTheRotorsAreNotReportedToRun) {
  inputs_.rotors_running = false;
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 9.9));
  EXPECT_TRUE(step_until(Mode::kDisarmed, 0.2));
  EXPECT_EQ(supervisor_.reason(), Reason::kRotorsNotRunning);

  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 9.0));
  inputs_.rotors_running = true;
  EXPECT_TRUE(step_until(Mode::kHolding, 10.0));
}

// GIVEN a vehicle that obeys another controller, or none, WHEN it is armed THEN that is not done, and ends after 1 s with that reason; one
// that obeys after 0.9 s takes off, and not before.
TEST_F(TakeoffAndLanding, ArmingIsDoneWhenTheVehicleObeys) {
  inputs_.not_obeyed_s = 2.0;
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 0.9));
  EXPECT_EQ(supervisor_.requests().back().state, RequestState::kExecuting);
  EXPECT_TRUE(step_until(Mode::kDisarmed, 0.2));
  EXPECT_EQ(supervisor_.reason(), Reason::kNotObeyed);
  EXPECT_EQ(supervisor_.requests().back().state, RequestState::kAborted);

  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_FALSE(step_until(Mode::kDisarmed, 0.9));
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kIdle);
  inputs_.not_obeyed_s = 0.0;
  step();
  const RequestStatuses& requests = supervisor_.requests();
  EXPECT_EQ(requests[requests.size() - 2].kind, RequestKind::kArm);
  EXPECT_EQ(requests[requests.size() - 2].state, RequestState::kSucceeded);
  EXPECT_TRUE(step_until(Mode::kHolding, 10.0));
}

// GIVEN a vehicle that stays on the ground, whether its lift-off is observed or not, WHEN it is to take off, low or high, THEN the take-off is
// not completed: it ends with that reason and the rotors off.
TEST_F(TakeoffAndLanding, ATakeOffThatDoesNotLeaveTheGroundIsNotCompleted) {
  follows_ = false;
  for (const std::int64_t lift_off_ns : {std::int64_t{0}, kNoLiftOffYet}) {
    for (const double height_m : {0.1, 0.5, 1.5}) {
      inputs_.lift_off_ns = lift_off_ns;
      ASSERT_TRUE(ask(RequestKind::kArm).accepted);
      ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -height_m}).accepted);
      ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0)) << height_m;
      EXPECT_EQ(supervisor_.reason(), Reason::kNoLiftOff);
      EXPECT_EQ(supervisor_.requests().back().state, RequestState::kAborted);
    }
  }
}

// GIVEN commands that the vehicle obeys late WHEN it spools up THEN the lift rises by no more than 0.08 of the weight in that time.
TEST_F(TakeoffAndLanding, LiftRisesSlowerOverALinkWithDelay) {
  const auto steepest_rise = [&](double delay_s) {
    inputs_.command_delay_s = delay_s;
    inputs_.lift_off_ns = kNoLiftOffYet;
    EXPECT_TRUE(ask(RequestKind::kArm).accepted);
    EXPECT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    step();
    double steepest = 0.0;
    double before = 1.0;
    std::int64_t before_ns = inputs_.stamp_ns;
    step_until(
        [&] {
          const double lift = control_setpoint_.lift_fraction;
          if (before > 0.8 && before < 1.0 && lift > before)
            steepest = std::max(steepest, (lift - before) / elapsed_s(before_ns, inputs_.stamp_ns));
          before = lift;
          before_ns = inputs_.stamp_ns;
          return lift > 1.2;
        },
        3.0);
    EXPECT_TRUE(ask(RequestKind::kDisarm).accepted);
    return steepest;
  };
  EXPECT_NEAR(steepest_rise(0.002), 3.0, 1e-6);
  EXPECT_NEAR(steepest_rise(0.08), 1.0, 1e-6);
  EXPECT_NEAR(steepest_rise(0.16), 0.5, 1e-6);
}

}  // namespace swiftlet::control::takeoff_and_landing_test

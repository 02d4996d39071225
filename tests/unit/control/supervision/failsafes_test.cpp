// What happens without poses, with a low battery and when the vehicle tips over.
#include <gtest/gtest.h>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::failsafes_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

class FlightFailsafes : public tests::FlightTest {};

TEST_F(FlightFailsafes, PoseLossDescendsLevelAndItsReturnHolds) {
  hover();
  inputs_.pose_age_s = 0.4;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  inputs_.pose_age_s = 0.6;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kLevelDescent);
  inputs_.pose_age_s = 0.0;
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
}

TEST_F(FlightFailsafes, DescentWithoutPositionEndsOnTheGroundOrByTimeout) {
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  ASSERT_TRUE(step_until(Mode::kDisarmed, 1.0));
  inputs_.vertical_specific_force_residual = 0.0;
  inputs_.pose_age_s = 0.0;
  estimate_ = Estimate();
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kStopped, 8.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kDescentTimedOut);
}

// Each descent has its own timeout: several of 4 s do not add up.
TEST_F(FlightFailsafes, DescentTimeoutStartsWithEachDescent) {
  hover();
  for (int descent = 0; descent < 3; ++descent) {
    inputs_.pose_age_s = 1.0;
    ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
    ASSERT_FALSE(step_until(Mode::kStopped, 4.0)) << descent;
    inputs_.pose_age_s = 0.0;
    ASSERT_TRUE(step_until(Mode::kHolding, 0.1));
    for (int i = 0; i < 50; ++i) step();
  }
}

// GIVEN a short ground contact in a canceled landing, WHEN the pose is lost later at 1 m, THEN a gust of two
// samples does not count as the rest of that contact.
TEST_F(FlightFailsafes, ForgetsContactOfACanceledLanding) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().contact_since_ns != 0; }, 20.0))
      << "no ground contact";
  ASSERT_EQ(supervisor_.mode(), Mode::kLanding);
  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.z() < -0.99; }, 20.0));
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  step();
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kLevelDescent);
}

// A landing needs contact for 0.2 s, a descent without position for 0.3 s of its own.
TEST_F(FlightFailsafes, DescentDoesNotContinueTheContactOfALanding) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until([&] { return supervisor_.state().contact_since_ns != 0; }, 20.0));
  for (int i = 0; i < 75; ++i) step();
  ASSERT_EQ(supervisor_.mode(), Mode::kLanding);
  inputs_.pose_age_s = 1.0;
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 125; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent) << "after 0.25 s";
  ASSERT_TRUE(step_until(Mode::kDisarmed, 0.1));
}

TEST_F(FlightFailsafes, ForgetsContactBeforeThePoseReturned) {
  hover();
  inputs_.pose_age_s = 1.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 0.1));
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 50; ++i) step();
  inputs_.pose_age_s = 0.0;
  ASSERT_TRUE(step_until(Mode::kHolding, 0.1));
  inputs_.vertical_specific_force_residual = 0.0;
  for (int i = 0; i < 500; ++i) step();
  inputs_.pose_age_s = 1.0;
  inputs_.vertical_specific_force_residual = 2.0;
  for (int i = 0; i < 10; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
}

// A low battery at the end of a flight does not count for its replacement, whose voltage sags briefly as the
// rotors start.
TEST_F(FlightFailsafes, ForgetsALowBatteryOnTheGround) {
  for (const double voltage_v : {3.2, 2.9}) {
    SupervisedFlight flight;
    ASSERT_TRUE(flight.take_off());
    flight.inputs_.supply_voltage_v = voltage_v;
    for (int i = 0; i < 20; ++i) flight.step();
    ASSERT_TRUE(flight.ask(RequestKind::kStop).accepted);
    ASSERT_TRUE(flight.ask(RequestKind::kDisarm).accepted);
    flight.estimate_ = Estimate();
    flight.inputs_.supply_voltage_v = 4.0;
    for (int i = 0; i < 2500; ++i) flight.step();
    ASSERT_TRUE(flight.ask(RequestKind::kArm).accepted);
    ASSERT_TRUE(flight.ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
    flight.inputs_.supply_voltage_v = voltage_v;
    for (int i = 0; i < 5; ++i) flight.step();
    EXPECT_EQ(flight.supervisor_.mode(), Mode::kTakingOff) << voltage_v;
  }
}

TEST_F(FlightFailsafes, TippingOverStopsTheRotors) {
  hover();
  estimate_.q_ned_from_frd = Eigen::AngleAxisd(1.6, Vector3d::UnitY());
  step();
  EXPECT_EQ(supervisor_.mode(), Mode::kStopped);
  EXPECT_EQ(control_setpoint_.control_mode, ControlMode::kOff);
  ASSERT_TRUE(ask(RequestKind::kDisarm).accepted);
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
}

TEST_F(FlightFailsafes, LandsOnlyIfTheBatteryStaysLow) {
  hover();
  inputs_.supply_voltage_v = 3.2;
  for (int i = 0; i < 250; ++i) step();
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  inputs_.supply_voltage_v = 3.5;
  step();
  inputs_.supply_voltage_v = 3.2;
  ASSERT_TRUE(step_until(Mode::kLanding, 1.5));
  EXPECT_EQ(supervisor_.reason(), Reason::kBatteryLow);
}

TEST_F(FlightFailsafes, FailsafeOverridesARequestOfTheSameStep) {
  hover();
  inputs_.pose_age_s = 10.0;
  step_with(RequestKind::kHold);
  EXPECT_EQ(supervisor_.mode(), Mode::kDescent);
}

}  // namespace swiftlet::control::failsafes_test

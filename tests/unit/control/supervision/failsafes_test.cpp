// Failsafes over several steps: what triggers them, what follows, and the links to the ground.
#include <vector>

#include <gtest/gtest.h>

#include "tests/unit/control/placed_flight.hpp"

namespace swiftlet::control::failsafes_test {

TEST(Failsafes, BatteryMustStayLowForTheDelay) {
  SupervisionSettings settings;
  settings.failsafe.battery_delay_s = 0.5;
  for (const double voltage_v : {3.2, 3.0}) {
    SupervisedFlight flight(settings);
    ASSERT_TRUE(flight.take_off());
    flight.inputs_.supply_voltage_v = voltage_v;
    EXPECT_FALSE(flight.step_until(Mode::kLanding, 0.49));
    flight.inputs_.supply_voltage_v = 3.5;
    flight.step();
    flight.inputs_.supply_voltage_v = voltage_v;
    EXPECT_FALSE(flight.step_until(Mode::kLanding, 0.49));
    EXPECT_TRUE(flight.step_until(Mode::kLanding, 0.03));
  }
}

TEST(Failsafes, CriticalBatteryLandsFasterThanLowBattery) {
  const auto landing_s = [](double voltage_v) {
    Placed flight(kLand);
    EXPECT_TRUE(flight.take_off());
    flight.inputs_.supply_voltage_v = voltage_v;
    const std::int64_t start_ns = flight.inputs_.stamp_ns;
    EXPECT_TRUE(flight.step_until(Mode::kDisarmed, 30.0));
    return static_cast<double>(flight.inputs_.stamp_ns - start_ns) * 1e-9;
  };
  EXPECT_LT(landing_s(3.0), 0.8 * landing_s(3.2));
}

TEST(Failsafes, LandsInsideAfterLeavingTheFence) {
  Placed flight(kLand);
  ASSERT_TRUE(flight.take_off());
  ASSERT_TRUE(flight.ask(RequestKind::kGoTo, {2.5, 0, -1}).accepted);
  ASSERT_TRUE(flight.step_until([&] { return flight.estimate_.position_ned.x() > 2.0; }, 20.0));
  flight.follows_ = false;
  flight.estimate_.position_ned.x() = 3.4;
  flight.step();
  ASSERT_EQ(flight.mode(), Mode::kLanding);
  flight.follows_ = true;
  ASSERT_TRUE(flight.step_until(Mode::kDisarmed, 30.0));
  EXPECT_LE(flight.estimate_.position_ned.x(), 3.0 + 1e-9);
}

TEST(Failsafes, LandingResumesWhenThePoseReturns) {
  for (const bool of_a_mission : {false, true}) {
    Placed flight(kLand);
    if (of_a_mission) {
      ASSERT_TRUE(flight.ask(RequestKind::kArm).accepted);
      ASSERT_TRUE(flight.fly(flight.mission_).accepted);
      ASSERT_TRUE(flight.step_until([&] { return flight.supervisor_.mission().item_index == 2; }, 20.0));
    } else {
      ASSERT_TRUE(flight.take_off());
      ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
    }
    flight.inputs_.pose_age_s = 1.0;
    ASSERT_TRUE(flight.step_until(Mode::kDescent, 0.1));
    flight.inputs_.pose_age_s = 0.0;
    flight.step();
    EXPECT_EQ(flight.mode(), Mode::kLanding);
    EXPECT_EQ(flight.supervisor_.reason(), Reason::kPoseIsBack);
    EXPECT_TRUE(flight.step_until(Mode::kDisarmed, 20.0));
  }
}

// GIVEN a landing that continued after a loss of the pose, WHEN it is canceled and the pose is lost again,
// THEN the vehicle holds as the pose returns.
TEST(Failsafes, CanceledLandingDoesNotResumeAfterTheNextLossOfPose) {
  Placed flight(kLand);
  ASSERT_TRUE(flight.take_off());
  ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
  const auto lose_the_pose = [&] {
    flight.inputs_.pose_age_s = 1.0;
    EXPECT_TRUE(flight.step_until(Mode::kDescent, 0.1));
    flight.inputs_.pose_age_s = 0.0;
    flight.step();
  };
  lose_the_pose();
  ASSERT_EQ(flight.mode(), Mode::kLanding);
  ASSERT_TRUE(flight.ask(RequestKind::kGoTo, {0, 0, -1}).accepted);
  lose_the_pose();
  EXPECT_EQ(flight.mode(), Mode::kHolding);
  EXPECT_EQ(flight.supervisor_.reason(), Reason::kPoseIsBack);
}

TEST(Failsafes, LandingRequestedWithoutPoseStartsWhenItReturns) {
  Placed flight(kLand);
  ASSERT_TRUE(flight.take_off());
  flight.inputs_.pose_age_s = 1.0;
  flight.step();
  ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
  EXPECT_EQ(flight.mode(), Mode::kDescent);
  flight.inputs_.pose_age_s = 0.0;
  flight.step();
  EXPECT_EQ(flight.mode(), Mode::kLanding);
}

TEST(EngagedInFlight, ComesToRestAndHoldsButNeedsAPose) {
  Placed flight(kLand);
  flight.estimate_.position_ned = {1.0, 0.0, -1.5};
  flight.estimate_.velocity_ned = {0.8, 0.0, 0.0};
  flight.inputs_.pose_age_s = 0.6;
  EXPECT_FALSE(flight.supervisor_.engage_in_flight(flight.inputs_).accepted);
  EXPECT_EQ(flight.mode(), Mode::kDisarmed);
  flight.inputs_.pose_age_s = 0.0;
  ASSERT_TRUE(flight.supervisor_.engage_in_flight(flight.inputs_).accepted);
  flight.step();
  EXPECT_EQ(flight.control_setpoint_.control_mode, ControlMode::kFly);
  EXPECT_NEAR(flight.control_setpoint_.reference.velocity_ned.x(), 0.8, 0.02);
  flight.step_until([] { return false; }, 3.0);
  EXPECT_EQ(flight.control_setpoint_.reference.velocity_ned, Vector3d::Zero());
  ASSERT_TRUE(flight.ask(RequestKind::kLand).accepted);
  EXPECT_TRUE(flight.step_until(Mode::kDisarmed, 20.0));
}

class GroundLinks : public testing::Test {
 protected:
  // Flies for seconds, with a heartbeat of these clients each 0.2 s.
  void fly_for(double seconds, const std::vector<std::uint64_t>& clients) {
    const std::int64_t end_ns = flight_.inputs_.stamp_ns + std::llround(seconds * 1e9);
    for (int i = 0; flight_.inputs_.stamp_ns < end_ns; ++i) {
      if (i % 100 == 0) {
        for (const std::uint64_t client : clients)
          EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({client, true}));
      }
      flight_.step();
    }
  }
  Placed flight_{kLand};
};

TEST_F(GroundLinks, FlightWithoutClientsContinues) {
  ASSERT_TRUE(flight_.take_off());
  fly_for(5.0, {});
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
}

TEST_F(GroundLinks, SilentClientTriggersDespiteAnother) {
  ASSERT_TRUE(flight_.take_off());
  fly_for(5.0, {1, 2});
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
  fly_for(0.7, {2});
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
  fly_for(0.4, {2});
  EXPECT_EQ(flight_.mode(), Mode::kLanding);
  EXPECT_EQ(flight_.supervisor_.reason(), Reason::kGroundLinkLost);
}

TEST_F(GroundLinks, ClientThatLeavesDoesNotTrigger) {
  ASSERT_TRUE(flight_.take_off());
  fly_for(1.0, {1});
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({1, false}));
  fly_for(3.0, {});
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
}

TEST_F(GroundLinks, LossTriggersOnceOnly) {
  ASSERT_TRUE(flight_.take_off());
  fly_for(1.0, {1});
  ASSERT_TRUE(flight_.step_until(Mode::kLanding, 1.2));
  ASSERT_TRUE(flight_.ask(RequestKind::kHold).accepted);
  fly_for(3.0, {});
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
}

TEST_F(GroundLinks, LossWithoutPoseTriggersWhenThePoseReturns) {
  ASSERT_TRUE(flight_.take_off());
  fly_for(1.0, {1});
  flight_.inputs_.pose_age_s = 1.0;
  fly_for(2.0, {});
  ASSERT_EQ(flight_.mode(), Mode::kDescent);
  flight_.inputs_.pose_age_s = 0.0;
  flight_.step();
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
  flight_.step();
  EXPECT_EQ(flight_.mode(), Mode::kLanding);
  EXPECT_EQ(flight_.supervisor_.reason(), Reason::kGroundLinkLost);
}

TEST_F(GroundLinks, RefusesMoreClientsThanFit) {
  for (std::uint64_t client = 1; client <= kMaxGroundLinks; ++client)
    EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({client, true}));
  EXPECT_FALSE(flight_.supervisor_.ground_heartbeat({99, true}));
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({99, false})) << "it was not registered";
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({2, true}));
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({3, false}));
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({99, true}));
}

TEST_F(GroundLinks, LossOnTheGroundDoesNotEndTheNextFlight) {
  EXPECT_TRUE(flight_.supervisor_.ground_heartbeat({1, true}));
  fly_for(3.0, {});
  ASSERT_TRUE(flight_.take_off());
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
}

}  // namespace swiftlet::control::failsafes_test

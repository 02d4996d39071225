// When the supervisor refuses a change of gains.
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/types/gains.hpp"
#include "tests/unit/control/placed_flight.hpp"

namespace swiftlet::control::gain_change_request_test {

class GainChangeRequest : public testing::Test {
 protected:
  void SetUp() override {
    flight_.inputs_.gains = &gains_;
    ASSERT_TRUE(flight_.take_off());
  }
  std::string refusal() {
    Request request = flight_.next_request(RequestKind::kSettings);
    request.gains = &change_;
    return flight_.supervisor_.request(request, flight_.inputs_).reason;
  }

  Placed flight_{kLand};
  ControlGains gains_;
  GainChange change_;
};

TEST_F(GainChangeRequest, IsAcceptedInCalmFlight) {
  EXPECT_EQ(refusal(), "");
  EXPECT_EQ(flight_.mode(), Mode::kHolding);
}

TEST_F(GainChangeRequest, IsRefusedWhileTheRotorsAreSaturated) {
  flight_.inputs_.unsaturated_s = 0.12;
  EXPECT_EQ(refusal(),
            "cannot change the gains: the rotors were saturated 0.12 s ago, must be at least 0.5 s");
  flight_.inputs_.unsaturated_s = 0.5;
  EXPECT_EQ(refusal(), "");
}

TEST_F(GainChangeRequest, IsRefusedInViolentMotion) {
  const Estimate calm = flight_.estimate_;
  flight_.estimate_.q_ned_from_frd = Eigen::AngleAxisd(0.4, Vector3d::UnitX());
  EXPECT_EQ(refusal(), "cannot change the gains: the tilt is 0.40 rad, must be at most 0.30 rad");
  flight_.estimate_ = calm;
  flight_.estimate_.body_rates_frd.y() = 3.5;
  EXPECT_EQ(refusal(), "cannot change the gains: the body rate is 3.50 rad/s, must be at most 3.00 rad/s");
  flight_.estimate_ = calm;
  flight_.estimate_.position_ned.x() += 0.25;
  EXPECT_EQ(refusal(),
            "cannot change the gains: the vehicle is 0.25 m off its reference, must be at most 0.20 m");
}

TEST_F(GainChangeRequest, IsRefusedWithoutAPose) {
  flight_.inputs_.pose_age_s = 0.6;
  EXPECT_EQ(refusal(), "cannot change the gains without a mocap pose");
}

TEST_F(GainChangeRequest, IsRefusedDuringAttitudeSetpoints) {
  ASSERT_TRUE(flight_.tilt().accepted);
  EXPECT_EQ(refusal(), "cannot change the gains during setpoints of attitude or body rates");
}

TEST_F(GainChangeRequest, IsRefusedWhileAMissionTakesOff) {
  Placed mission(kLand);
  ASSERT_TRUE(mission.ask(RequestKind::kArm).accepted && mission.fly(mission.mission_).accepted);
  ASSERT_TRUE(mission.step_until([&] { return mission.supervisor_.airborne(); }, 5.0));
  Request request = mission.next_request(RequestKind::kSettings);
  request.gains = &change_;
  EXPECT_STREQ(mission.supervisor_.request(request, mission.inputs_).reason,
               "cannot change the gains while the mission takes off or lands");
}

TEST_F(GainChangeRequest, ProgressesWithTheGains) {
  flight_.inputs_.gains_progress = 0.0;
  ASSERT_EQ(refusal(), "");
  const RequestStatus& request = flight_.supervisor_.requests().back();
  flight_.inputs_.gains_changing_s = 1.0;
  flight_.step();
  flight_.inputs_.gains_progress = 0.4;
  flight_.step();
  EXPECT_EQ(flight_.supervisor_.requests().back().state, RequestState::kExecuting);
  EXPECT_EQ(request.progress, 0.4);
  EXPECT_EQ(refusal(), "the gains are still changing, for another 1.0 s");
  flight_.inputs_.gains_progress = 1.0;
  flight_.inputs_.gains_changing_s = 0.0;
  flight_.step();
  EXPECT_EQ(flight_.supervisor_.requests().back().state, RequestState::kSucceeded);
}

// GIVEN a change under way, WHEN the vehicle stops its rotors, THEN the request has succeeded: the gains
// change at once.
TEST_F(GainChangeRequest, SucceedsWhenTheRotorsStop) {
  ASSERT_EQ(refusal(), "");
  flight_.inputs_.gains_progress = 0.1;
  flight_.step();
  flight_.step();
  ASSERT_TRUE(flight_.ask(RequestKind::kStop).accepted);
  for (const RequestStatus& request : flight_.supervisor_.requests()) {
    if (request.kind == RequestKind::kSettings) {
      EXPECT_EQ(request.state, RequestState::kSucceeded);
    }
  }
}

}  // namespace swiftlet::control::gain_change_request_test

// The request of a hover test, and how it ends.
#include <string>

#include <gtest/gtest.h>

#include "swiftlet/control/types/mode.hpp"
#include "tests/unit/control/supervision/flight_fixture.hpp"

namespace swiftlet::control::hover_test_request_test {

class HoverTestRequest : public tests::FlightTest {
 protected:
  void start() {
    ASSERT_TRUE(ask(RequestKind::kArm).accepted);
    const Outcome outcome = ask(RequestKind::kHoverTest);
    ASSERT_TRUE(outcome.accepted) << outcome.reason;
  }
  RequestState state() const { return supervisor_.requests().back().state; }
};

TEST_F(HoverTestRequest, HoversForTwoSecondsAtFifteenCentimetresAndLands) {
  start();
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kHoverTest);
  EXPECT_NEAR(estimate_.position_ned.z(), -0.15, 1e-3);
  const std::int64_t since_ns = inputs_.stamp_ns;
  ASSERT_TRUE(step_until(Mode::kLanding, 10.0));
  EXPECT_EQ(supervisor_.reason(), Reason::kHoverTestPassed);
  EXPECT_NEAR(1e-9 * static_cast<double>(inputs_.stamp_ns - since_ns), 2.0, 0.01);
  EXPECT_EQ(state(), RequestState::kExecuting);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  EXPECT_EQ(state(), RequestState::kSucceeded);
}

// GIVEN a hover test in each of its modes WHEN a defect is found THEN the rotors are off and the request has failed.
TEST_F(HoverTestRequest, ADefectTurnsTheRotorsOff) {
  for (const Mode mode : {Mode::kTakingOff, Mode::kHolding, Mode::kLanding}) {
    inputs_.hover_test_defect = "";
    start();
    ASSERT_TRUE(step_until(mode, 10.0));
    inputs_.hover_test_defect = "rotors 1 and 2 are exchanged";
    step();
    EXPECT_EQ(supervisor_.mode(), Mode::kStopped);
    EXPECT_EQ(supervisor_.reason(), Reason::kHoverTestFailed);
    EXPECT_EQ(state(), RequestState::kAborted);
    ASSERT_TRUE(ask(RequestKind::kDisarm).accepted);
    estimate_.position_ned.setZero();
    estimate_.velocity_ned.setZero();
  }
}

TEST_F(HoverTestRequest, AnotherRequestEndsIt) {
  start();
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  EXPECT_EQ(supervisor_.requests()[supervisor_.requests().size() - 2].state, RequestState::kCanceled);
  step_until([] { return false; }, 3.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding) << "it does not land";
}

TEST_F(HoverTestRequest, IsRefusedInFlight) {
  ASSERT_TRUE(take_off());
  EXPECT_STREQ(ask(RequestKind::kHoverTest).reason, "already airborne; use goto");
}

}  // namespace swiftlet::control::hover_test_request_test

// Progress and result of each kind of accepted request.
#include "swiftlet/control/supervision/request_progress.hpp"

#include <string>

#include <gtest/gtest.h>

#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control::request_progress_test {

using Eigen::Vector3d;
using tests::SupervisedFlight;

class RequestProgress : public testing::Test, protected SupervisedFlight {
 protected:
  const RequestStatus& last() const { return supervisor_.requests().back(); }
  const RequestStatus& numbered(std::uint64_t id) const {
    for (const RequestStatus& request : supervisor_.requests()) {
      if (request.key == RequestKey{1, id}) return request;
    }
    static const RequestStatus unknown;
    return unknown;
  }
  std::string end_of(std::uint64_t id) const {
    return to_string(numbered(id).state) + (" " + result_of(numbered(id)));
  }
  bool step_until_over(std::uint64_t id, double limit_s) {
    return step_until([&] { return is_over(numbered(id).state); }, limit_s);
  }
  void hover() {
    ASSERT_TRUE(take_off());
    step();
    ASSERT_EQ(last().state, RequestState::kSucceeded);
  }
  // From now on progress never falls, and ends at 1.
  void expect_rising_progress(std::uint64_t id, double limit_s) {
    double before = numbered(id).progress;
    double middle = 0.0;
    while (!is_over(numbered(id).state) && limit_s > 0.0) {
      step();
      limit_s -= 1e-9 * static_cast<double>(kStep_ns);
      const double now = numbered(id).progress;
      ASSERT_GE(now, before);
      ASSERT_LE(now, 1.0);
      if (now > 0.4 && now < 0.6) middle = now;
      before = now;
    }
    EXPECT_EQ(end_of(id), "succeeded ");
    EXPECT_EQ(before, 1.0);
    EXPECT_GT(middle, 0.0);
  }
  Mission two_places() const {
    Mission mission;
    mission.id = 7;
    mission.items = {{MissionItemKind::kWaypoint, {1, 0, -1}, 0, true, 0.5, 0.1},
                     {MissionItemKind::kWaypoint, {0, 0, -1}, 0, true, 0.5, 0.1}};
    return mission;
  }
};

TEST_F(RequestProgress, IsUnknownBeforeTheFirstRequest) {
  for (const RequestStatus& request : supervisor_.requests())
    EXPECT_EQ(request.state, RequestState::kUnknown);
}

TEST_F(RequestProgress, IsNotKeptForRefusedRequests) {
  EXPECT_FALSE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_EQ(last().state, RequestState::kUnknown);
}

TEST_F(RequestProgress, ArmDisarmAndStopSucceedAtOnce) {
  for (const RequestKind kind : {RequestKind::kArm, RequestKind::kDisarm, RequestKind::kStop}) {
    ASSERT_TRUE(ask(kind).accepted);
    EXPECT_EQ(last().key.id, asked_);
    EXPECT_EQ(last().kind, kind);
    EXPECT_EQ(last().state, RequestState::kSucceeded);
    EXPECT_EQ(last().progress, 1.0);
  }
}

TEST_F(RequestProgress, TakeoffSucceedsAtItsHeight) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  EXPECT_EQ(last().state, RequestState::kAccepted);
  step();
  EXPECT_EQ(last().state, RequestState::kExecuting);
  expect_rising_progress(asked_, 10.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kHolding);
  EXPECT_NEAR(estimate_.position_ned.z(), -1.0, kThere_m);
}

// GIVEN a vehicle that lags behind, WHEN its reference is at the height, THEN the take-off goes on until the
// vehicle is, too.
TEST_F(RequestProgress, TakeoffWaitsForTheVehicle) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  ASSERT_TRUE(step_until([&] { return estimate_.position_ned.z() < -0.8; }, 10.0));
  follows_ = false;
  ASSERT_TRUE(step_until(Mode::kHolding, 10.0));
  for (int i = 0; i < 500; ++i) step();
  EXPECT_EQ(last().state, RequestState::kExecuting);
  follows_ = true;
  EXPECT_TRUE(step_until_over(asked_, 0.1));
  EXPECT_EQ(last().state, RequestState::kSucceeded);
}

TEST_F(RequestProgress, GoToAndHoldSucceedAtRest) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kGoTo, {1, 0, -1}).accepted);
  step();
  EXPECT_EQ(last().state, RequestState::kExecuting);
  expect_rising_progress(asked_, 10.0);
  EXPECT_NEAR(estimate_.position_ned.x(), 1.0, kThere_m);

  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0, -1}).accepted);
  const std::uint64_t left = asked_;
  for (int i = 0; i < 400; ++i) step();
  ASSERT_TRUE(ask(RequestKind::kHold).accepted);
  EXPECT_EQ(end_of(left), "canceled canceled by a newer request: hold");
  step();
  EXPECT_EQ(last().state, RequestState::kExecuting);
  ASSERT_TRUE(step_until_over(asked_, 5.0));
  EXPECT_LT(estimate_.velocity_ned.norm(), kStandstill_m_s);
  EXPECT_GT(estimate_.position_ned.x(), 0.1);
}

TEST_F(RequestProgress, LandingSucceedsOnTheGround) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  step();
  expect_rising_progress(asked_, 10.0);
  EXPECT_EQ(supervisor_.mode(), Mode::kDisarmed);
}

TEST_F(RequestProgress, LandingWithoutPositionSucceedsOnTheGround) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  for (int i = 0; i < 100; ++i) step();
  inputs_.pose_age_s = 10.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 1.0));
  EXPECT_EQ(last().state, RequestState::kExecuting);
  inputs_.vertical_specific_force_residual = 5.0;
  ASSERT_TRUE(step_until(Mode::kDisarmed, 5.0));
  EXPECT_EQ(last().state, RequestState::kSucceeded);
}

TEST_F(RequestProgress, LandingDuringSpoolUpSucceedsAtOnce) {
  ASSERT_TRUE(ask(RequestKind::kArm).accepted);
  ASSERT_TRUE(ask(RequestKind::kTakeoff, {0, 0, -1}).accepted);
  step();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  EXPECT_EQ(last().state, RequestState::kSucceeded);
  EXPECT_EQ(end_of(asked_ - 1), "canceled canceled by a newer request: land");
}

TEST_F(RequestProgress, BothOfTwoLandingsSucceed) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  step();
  ASSERT_TRUE(ask(RequestKind::kLand).accepted);
  ASSERT_TRUE(step_until(Mode::kDisarmed, 10.0));
  EXPECT_EQ(end_of(asked_), "succeeded ");
  EXPECT_EQ(end_of(asked_ - 1), "succeeded ");
}

TEST_F(RequestProgress, TrajectorySucceedsAtItsEnd) {
  hover();
  Trajectory trajectory;
  trajectory.id = 3;
  PolynomialSegment there;
  there.duration_s = 4.0;
  there.x = {0, 0, 0, 10.0 / 64, -15.0 / 256, 6.0 / 1024};
  there.z = {-1.0};
  PolynomialSegment rest;
  rest.duration_s = 1.0;
  rest.x = {1.0};
  rest.z = {-1.0};
  trajectory.segments = {there, rest};
  ASSERT_TRUE(fly(trajectory).accepted);
  step();
  EXPECT_EQ(last().state, RequestState::kExecuting);
  expect_rising_progress(asked_, 10.0);
  EXPECT_EQ(supervisor_.reason(), Reason::kTrajectoryCompleted);

  ASSERT_TRUE(fly(trajectory).accepted);
  step();
  ASSERT_TRUE(fly(trajectory).accepted);
  EXPECT_EQ(end_of(asked_ - 1), "canceled canceled by a newer request: trajectory");
}

TEST_F(RequestProgress, MissionSucceedsAfterPauses) {
  hover();
  const Mission mission = two_places();
  ASSERT_TRUE(upload(mission).accepted);
  EXPECT_EQ(last().state, RequestState::kSucceeded);
  ASSERT_TRUE(ask(RequestKind::kMissionStart).accepted);
  const std::uint64_t start = asked_;
  for (int i = 0; i < 300; ++i) step();
  EXPECT_EQ(numbered(start).state, RequestState::kExecuting);

  ASSERT_TRUE(ask(RequestKind::kMissionPause).accepted);
  const std::uint64_t pause = asked_;
  step();
  EXPECT_EQ(numbered(pause).state, RequestState::kExecuting);
  ASSERT_TRUE(step_until_over(pause, 5.0));
  EXPECT_EQ(end_of(pause), "succeeded ");
  EXPECT_EQ(control_setpoint_.reference.velocity_ned, Vector3d::Zero());
  EXPECT_EQ(numbered(start).state, RequestState::kExecuting);

  ASSERT_TRUE(ask(RequestKind::kGoTo, {0, 0.3, -1}).accepted);
  const std::uint64_t aside = asked_;
  ASSERT_TRUE(step_until_over(aside, 10.0));
  EXPECT_EQ(end_of(aside), "succeeded ");
  EXPECT_EQ(numbered(start).state, RequestState::kExecuting);

  ASSERT_TRUE(ask(RequestKind::kMissionResume).accepted);
  const std::uint64_t resume = asked_;
  step();
  expect_rising_progress(start, 20.0);
  EXPECT_EQ(end_of(resume), "succeeded ");
  EXPECT_EQ(supervisor_.mission().state, MissionState::kCompleted);
}

TEST_F(RequestProgress, MissionResultNamesTheCause) {
  const Mission mission = two_places();
  const auto begin = [&](SupervisedFlight& flight) {
    ASSERT_TRUE(flight.take_off());
    ASSERT_TRUE(flight.fly(mission).accepted);
    for (int i = 0; i < 300; ++i) flight.step();
  };
  const auto result = [](const SupervisedFlight& flight, std::uint64_t id) {
    for (const RequestStatus& request : flight.supervisor_.requests()) {
      if (request.key.id == id) return result_of(request);
    }
    return std::string("unknown");
  };
  {
    SupervisedFlight flight;
    begin(flight);
    const std::uint64_t start = flight.asked_;
    ASSERT_TRUE(flight.ask(RequestKind::kHold).accepted);
    EXPECT_EQ(result(flight, start), "canceled by a newer request: hold");
  }
  {
    SupervisedFlight flight;
    begin(flight);
    const std::uint64_t start = flight.asked_;
    ASSERT_TRUE(flight.ask(RequestKind::kMissionPause).accepted);
    ASSERT_TRUE(flight.ask(RequestKind::kMissionClear).accepted);
    EXPECT_EQ(result(flight, start), "canceled by a newer request: mission clear");
    EXPECT_EQ(result(flight, start + 1), "") << "the pause itself is not canceled";
  }
  {
    SupervisedFlight flight;
    begin(flight);
    flight.inputs_.supply_voltage_v = 3.0;
    ASSERT_TRUE(flight.step_until(Mode::kLanding, 10.0));
    EXPECT_EQ(result(flight, flight.asked_),
              std::string("aborted: ") + to_string(flight.supervisor_.reason()));
  }
}

TEST_F(RequestProgress, FailsafeAbortsWithItsReason) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kGoTo, {1, 0, -1}).accepted);
  for (int i = 0; i < 100; ++i) step();
  inputs_.pose_age_s = 10.0;
  ASSERT_TRUE(step_until(Mode::kDescent, 1.0));
  EXPECT_EQ(end_of(asked_), "aborted aborted: no mocap pose");
  EXPECT_LT(last().progress, 0.5) << "progress stops where it was";
}

TEST_F(RequestProgress, SetpointsCancelTheActiveRequest) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kGoTo, {1, 0, -1}).accepted);
  for (int i = 0; i < 100; ++i) step();
  Setpoint setpoint;
  setpoint.position_ned = control_setpoint_.reference.position_ned;
  setpoint.yaw_free = true;
  ASSERT_TRUE(supervisor_.setpoint(setpoint, inputs_).accepted);
  EXPECT_EQ(end_of(asked_), "canceled canceled by setpoints");
}

// GIVEN an active mission, WHEN more requests follow than are remembered, THEN the mission is not forgotten.
TEST_F(RequestProgress, ActiveRequestIsForgottenLast) {
  hover();
  const Mission mission = two_places();
  ASSERT_TRUE(fly(mission).accepted);
  const std::uint64_t start = asked_;
  step();
  ASSERT_TRUE(ask(RequestKind::kMissionPause).accepted);
  for (int i = 0; i < 2 * kRememberedRequests; ++i) {
    ASSERT_TRUE(ask(RequestKind::kGoTo, {0.1 * i, 0, -1}).accepted);
    step();
  }
  EXPECT_EQ(numbered(start).state, RequestState::kExecuting);
  EXPECT_EQ(last().key.id, asked_);
}

// GIVEN a standby that adopts the state during a goto, WHEN it flies on, THEN the request succeeds there.
TEST_F(RequestProgress, IsContinuedByAStandby) {
  hover();
  ASSERT_TRUE(ask(RequestKind::kGoTo, {1, 0, -1}).accepted);
  for (int i = 0; i < 300; ++i) step();
  const double before = last().progress;
  ASSERT_GT(before, 0.0);
  Supervisor standby{SupervisionSettings()};
  const SupervisorState state = supervisor_.state();
  standby.adopt(state, nullptr, nullptr);
  supervisor_ = standby;
  EXPECT_EQ(last().progress, before);
  expect_rising_progress(asked_, 10.0);
  EXPECT_NEAR(estimate_.position_ned.x(), 1.0, kThere_m);
}

TEST_F(RequestProgress, UnknownMissionIsAborted) {
  hover();
  const Mission mission = two_places();
  ASSERT_TRUE(fly(mission).accepted);
  for (int i = 0; i < 300; ++i) step();
  const SupervisorState state = supervisor_.state();
  supervisor_.adopt(state, nullptr, nullptr);
  EXPECT_EQ(end_of(asked_), "aborted aborted: mission or trajectory unknown after failover");
}

}  // namespace swiftlet::control::request_progress_test

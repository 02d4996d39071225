#include "swiftlet/ground/fleet/order_execution.hpp"

#include <gtest/gtest.h>

#include "swiftlet/control/types/mode.hpp"

namespace swiftlet::ground::order_execution_test {

namespace msg = messages::msg;
using Request = OrderExecution::Request;
using State = MissionNews::State;

constexpr std::uint64_t kOurs = 7, kPilots = 8;
const Order kFly{};
const Order kPause{Order::Kind::kPause, Eigen::Vector3d::Zero(), 1};
const Order kAside{Order::Kind::kStepAside, {1.0, 2.0, -1.0}, 1};

TEST(OrderExecution, PausesAndResumes) {
  OrderExecution execution;
  EXPECT_EQ(execution.next(kFly, {State::kRuns, kOurs}, std::nullopt), Request::kNone);
  EXPECT_EQ(execution.next(kPause, {State::kRuns, kOurs}, std::nullopt), Request::kPause);
  EXPECT_EQ(execution.next(kPause, {State::kPaused, kOurs}, kOurs), Request::kNone);
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kOurs}, kOurs), Request::kResume);
  EXPECT_EQ(execution.next(kFly, {State::kRuns, kOurs}, kOurs), Request::kNone);
}

// GIVEN a mission that the pilot has paused THEN it is not resumed, also if the monitor would have paused it too.
TEST(OrderExecution, LeavesWhatThePilotHasPaused) {
  OrderExecution execution;
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kPilots}, std::nullopt), Request::kNone);
  EXPECT_EQ(execution.next(kPause, {State::kPaused, kPilots}, kOurs), Request::kNone);
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kPilots}, kOurs), Request::kNone);
  EXPECT_TRUE(execution.is_of_others());
  // The pilot resumes it: from then on it is the flight's again.
  EXPECT_EQ(execution.next(kPause, {State::kRuns, kPilots}, kOurs), Request::kPause);
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kOurs}, kOurs), Request::kResume);
}

// GIVEN a mission that the monitor has paused WHEN the pilot sends the vehicle elsewhere THEN it stays the pilot's.
TEST(OrderExecution, LeavesAVehicleThatThePilotHasMoved) {
  OrderExecution execution;
  EXPECT_EQ(execution.next(kPause, {State::kPaused, kOurs}, kOurs), Request::kNone);
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kPilots}, kOurs), Request::kNone);
}

TEST(OrderExecution, PausesBeforeItStepsAsideAndGoesBack) {
  OrderExecution execution;
  EXPECT_EQ(execution.next(kAside, {State::kRuns, kOurs}, kOurs), Request::kPause);
  EXPECT_EQ(execution.next(kAside, {State::kPaused, kOurs}, kOurs), Request::kGoTo);
  EXPECT_EQ(execution.next(kAside, {State::kPaused, kOurs}, kOurs), Request::kGoTo) << "until it is accepted";
  execution.accepted(Request::kGoTo, kAside);
  EXPECT_EQ(execution.next(kAside, {State::kPaused, kOurs}, kOurs), Request::kNone);
  Order other = kAside;
  other.place_ned.x() += 1.0;
  EXPECT_EQ(execution.next(other, {State::kPaused, kOurs}, kOurs), Request::kGoTo) << "to another place";
  EXPECT_EQ(execution.next(kPause, {State::kPaused, kOurs}, kOurs), Request::kNone) << "stays there";
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kOurs}, kOurs), Request::kResume);
  EXPECT_EQ(execution.next(kFly, {State::kRuns, kOurs}, kOurs), Request::kNone);
  EXPECT_EQ(execution.next(kAside, {State::kPaused, kOurs}, kOurs), Request::kGoTo)
      << "the same place as before";
}

// A vehicle of the pilot in danger steps aside, but remains the pilot's.
TEST(OrderExecution, DoesNotResumeWhatItMovedForThePilot) {
  OrderExecution execution;
  EXPECT_EQ(execution.next(kAside, {State::kPaused, kPilots}, kOurs), Request::kGoTo);
  execution.accepted(Request::kGoTo, kAside);
  EXPECT_EQ(execution.next(kFly, {State::kPaused, kOurs}, kOurs), Request::kNone);
}

TEST(OrderExecution, AsksNothingOfAMissionThatIsNotFlown) {
  OrderExecution execution;
  for (const Order& order : {kFly, kPause, kAside})
    EXPECT_EQ(execution.next(order, {State::kOther, kPilots}, kOurs), Request::kNone);
}

msg::RequestStatus request(std::uint64_t client, std::uint8_t kind) {
  msg::RequestStatus request;
  request.client(client);
  request.kind(kind);
  request.state(msg::RequestStatus_Constants::EXECUTING);
  return request;
}

TEST(MissionNews, NamesWhoMovedTheVehicleLast) {
  msg::ControlStatus control;
  msg::MissionStatus mission;
  mission.mission_id(5);
  mission.state(msg::MissionStatus_Constants::PAUSED);
  control.mode(static_cast<std::uint8_t>(control::Mode::kHolding));
  EXPECT_FALSE(mission_news(control, mission, 5).moved_by);
  control.request(request(kPilots, msg::RequestStatus_Constants::KIND_SETTINGS));
  control.earlier_requests()[0] = request(kOurs, msg::Command_Constants::MISSION_PAUSE);
  control.earlier_requests()[1] = request(kPilots, msg::Command_Constants::GOTO);
  EXPECT_EQ(mission_news(control, mission, 5).moved_by, kOurs) << "gains do not move it";
  EXPECT_EQ(mission_news(control, mission, 5).state, State::kPaused);
  EXPECT_EQ(mission_news(control, mission, 6).state, State::kOther) << "another mission";
  control.request(request(kPilots, msg::Command_Constants::GOTO));
  EXPECT_EQ(mission_news(control, mission, 5).moved_by, kPilots);
  control.mode(static_cast<std::uint8_t>(control::Mode::kMission));
  EXPECT_EQ(mission_news(control, mission, 5).state, State::kOther)
      << "control_status is from before the pause";
}

}  // namespace swiftlet::ground::order_execution_test

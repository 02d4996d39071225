// The result of an action, from the controller's status.
#include "swiftlet/ground/client/action.hpp"

#include <gtest/gtest.h>

#include "swiftlet/control/supervision/request_status.hpp"
#include "swiftlet/services/messages/convert.hpp"

namespace swiftlet::ground::action_test {

using control::Event;
using control::Reason;
using control::RequestKind;
using control::RequestState;
using control::RequestStatus;

constexpr std::int64_t kAccepted_ns = 5'000'000'000;
const Result kAnswer{Result::Kind::kAccepted, "", {7, 12}, kAccepted_ns};

swiftlet_msgs::msg::ControlStatus status(const RequestStatus& last,
                                         std::int64_t stamp_ns = kAccepted_ns + 1) {
  swiftlet_msgs::msg::ControlStatus status;
  status.stamp_ns(stamp_ns);
  status.request() = messages::to_message(last);
  return status;
}

RequestStatus in_state(RequestState state, Event by = Event::kArm, Reason reason = Reason::kStarted) {
  return {{7, 12}, RequestKind::kGoTo, state, by, reason, 0.5};
}

std::string summary_of(const std::optional<ActionResult>& result) {
  if (!result) return "under way";
  return result->done() ? "done" : result->reason;
}

TEST(ActionResults, FollowTheReportedRequestState) {
  EXPECT_EQ(summary_of(action_result_by(status(in_state(RequestState::kAccepted)), kAnswer)), "under way");
  EXPECT_EQ(summary_of(action_result_by(status(in_state(RequestState::kExecuting)), kAnswer)), "under way");
  EXPECT_EQ(summary_of(action_result_by(status(in_state(RequestState::kSucceeded)), kAnswer)), "done");
  const auto canceled =
      action_result_by(status(in_state(RequestState::kCanceled, Event::kLand, Reason::kRequested)), kAnswer);
  EXPECT_EQ(summary_of(canceled), "canceled by a newer request: land");
  EXPECT_EQ(canceled->kind, ActionResult::Kind::kCanceled);
  const auto aborted = action_result_by(
      status(in_state(RequestState::kAborted, Event::kBatteryLow, Reason::kBatteryLow)), kAnswer);
  EXPECT_EQ(summary_of(aborted), "aborted: battery is low");
  EXPECT_EQ(aborted->kind, ActionResult::Kind::kAborted);
}

TEST(ActionResults, AreReadFromEarlierRequests) {
  RequestStatus other = in_state(RequestState::kExecuting);
  for (const control::RequestKey& key : {control::RequestKey{7, 13}, control::RequestKey{8, 12}}) {
    other.key = key;
    auto reported = status(other);
    reported.earlier_requests()[2] = messages::to_message(in_state(RequestState::kSucceeded));
    EXPECT_EQ(summary_of(action_result_by(reported, kAnswer)), "done");
  }
}

// GIVEN a status without the request, WHEN it is older than the answer THEN the action is under way, WHEN it
// is newer THEN the action is lost.
TEST(ActionResults, AreLostWhenALaterStatusOmitsTheRequest) {
  RequestStatus other = in_state(RequestState::kSucceeded);
  other.key = {7, 11};
  EXPECT_EQ(summary_of(action_result_by(status(other, kAccepted_ns), kAnswer)), "under way");
  const auto lost = action_result_by(status(other, kAccepted_ns + 1), kAnswer);
  ASSERT_TRUE(lost);
  EXPECT_EQ(lost->kind, ActionResult::Kind::kLost);
  EXPECT_EQ(summary_of(action_result_by({}, kAnswer)), "under way");
}

TEST(Interruption, NamesWhatAnotherToolSent) {
  const auto text = [](Event ended_by) {
    RequestStatus request;
    request.state = RequestState::kCanceled;
    request.ended_by = ended_by;
    return interruption_by({ActionResult::Kind::kCanceled, result_of(request)});
  };
  EXPECT_EQ(text(Event::kGoTo), "mission interrupted: another ground tool sent goto");
  EXPECT_EQ(text(Event::kSetpoint), "mission interrupted: another ground tool sent setpoints");
  EXPECT_EQ(interruption_by({ActionResult::Kind::kCanceled, "replaced"}), "mission interrupted: replaced");
}

}  // namespace swiftlet::ground::action_test

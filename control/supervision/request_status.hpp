// The status of the requests that were accepted last, as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>

#include "swiftlet/control/supervision/events.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/control/types/request.hpp"

namespace swiftlet::control {

// Names and numbers are those of ROS 2's action_msgs/msg/GoalStatus.
enum class RequestState : std::uint8_t {
  kUnknown = 0,    // no such request
  kAccepted = 1,   // starts with the next step
  kExecuting = 2,  // the vehicle executes it
  kSucceeded = 4,
  kCanceled = 5,  // by a newer request
  kAborted = 6,   // by a failsafe
};
const char* to_string(RequestState state);  // "executing"
inline bool is_over(RequestState state) { return state >= RequestState::kSucceeded; }

struct RequestStatus {
  RequestKey key;
  RequestKind kind = RequestKind::kArm;
  RequestState state = RequestState::kUnknown;
  Event ended_by = Event::kArm;      // if canceled or aborted
  Reason reason = Reason::kStarted;  // likewise
  double progress = 0.0;  // 0 .. 1, never falls: fraction of the height of a take-off or landing, of a
                          // mission's items, of a trajectory's segments, of the time of other paths
};

constexpr int kRememberedRequests = 4;
using RequestStatuses = std::array<RequestStatus, kRememberedRequests>;  // oldest first
static_assert(std::is_trivially_copyable_v<RequestStatuses>);

// True if a request or its state differs; progress is ignored.
bool differ_in_state(const RequestStatuses& a, const RequestStatuses& b);

// "canceled by a newer request: land", "aborted: battery is low"; empty for other states.
std::string result_of(const RequestStatus& request);

}  // namespace swiftlet::control

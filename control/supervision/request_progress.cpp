#include "swiftlet/control/supervision/request_progress.hpp"

#include <algorithm>

namespace swiftlet::control {
namespace {

bool is_under_way(const RequestStatus& request) {
  return request.state == RequestState::kAccepted || request.state == RequestState::kExecuting;
}

bool is_of_mission(RequestKind kind) {
  return kind == RequestKind::kMissionStart || kind == RequestKind::kMissionResume ||
         kind == RequestKind::kMissionSkip;
}

bool is_done_when_accepted(RequestKind kind) {
  switch (kind) {
    case RequestKind::kDisarm:
    case RequestKind::kStop:
    case RequestKind::kMissionUpload:
    case RequestKind::kMissionClear:
      return true;
    default:
      return false;
  }
}

// True for requests of a client or user.
bool is_asked_for(Event event) { return is_request(event) && event < Event::kPlanUnknown; }

void succeed(RequestStatus& request) {
  request.state = RequestState::kSucceeded;
  request.progress = 1.0;
}

void fail(RequestStatus& request, const Transition& by) {
  request.state = is_asked_for(by.event) ? RequestState::kCanceled : RequestState::kAborted;
  request.ended_by = by.event;
  request.reason = by.reason;
}

// Requests that fly the mission end with it.
void end_with_mission(RequestStatus& request, MissionState mission, const Transition& row) {
  if (control::is_under_way(mission)) return;
  if (mission == MissionState::kCompleted) return succeed(request);
  fail(request, row);
}

// Requests with a path of their own end with it. A landing also succeeds on the ground after a descent
// without position.
void end_with_path(RequestStatus& request, Mode mode, const Transition& row) {
  if (row.event == Event::kMissionUpload || row.event == Event::kMissionClear ||
      row.event == Event::kSettings)
    return;
  switch (request.kind) {
    case RequestKind::kSettings:
      if (rotors_off(mode)) succeed(request);
      return;
    case RequestKind::kArm:  // it is done when the vehicle obeys
      if (!rotors_off(mode)) return;
      break;
    case RequestKind::kTakeoff:
      if (row.event == Event::kPlanFinished) return;  // the reference is at the end
      break;
    case RequestKind::kHoverTest:
      if (row.reason == Reason::kHoverTest || row.reason == Reason::kHoverTestPassed) return;
      if (row.reason == Reason::kLanded) return succeed(request);
      break;
    case RequestKind::kLand:
      if (mode == Mode::kLanding || mode == Mode::kDescent) return;
      if (mode == Mode::kDisarmed) return succeed(request);
      break;
    case RequestKind::kTrajectory:
      if (row.event == Event::kPlanFinished) return succeed(request);
      break;
    default:
      break;
  }
  fail(request, row);
}

double fraction(double part, double whole) { return whole > 0.0 ? std::clamp(part / whole, 0.0, 1.0) : 0.0; }

// Progress along the segment being flown, in path time.
double path_progress(const SupervisorState& state) {
  if (state.guidance.phase != Phase::kPath || !state.guidance.path.moving) return 0.0;
  return fraction(elapsed_s(state.guidance.path.start_ns, state.guidance.path.path_ns(state.now_ns)),
                  elapsed_s(state.guidance.path.start_ns, state.guidance.path.end_ns));
}

// next_segment is 0 while the vehicle moves to the start of the first segment.
double segments_progress(const SupervisorState& state, std::size_t count) {
  if (state.guidance.next_segment == 0) return 0.0;
  return fraction(state.guidance.next_segment - 1 + path_progress(state), static_cast<double>(count));
}

double mission_progress(const SupervisorContext& context) {
  const SupervisorState& state = context.state;
  if (context.plan.mission == nullptr || state.guidance.mission.state != MissionState::kRunning ||
      state.guidance.pause != MissionPause::kNone)
    return 0.0;
  const MissionItem& item =
      context.plan.mission->items[static_cast<std::size_t>(state.guidance.mission.item_index)];
  const double of_item = item.kind == MissionItemKind::kTrajectory
                             ? segments_progress(state, item.segment_count)
                             : path_progress(state);
  return fraction(state.guidance.mission.item_index + of_item, state.guidance.mission.item_count);
}

double progress(const RequestStatus& request, const SupervisorContext& context) {
  const SupervisorState& state = context.state;
  const double z_ned = context.estimate().position_ned.z();
  switch (request.kind) {
    case RequestKind::kTakeoff:
      return fraction(state.guidance.ground_z_ned - z_ned,
                      state.guidance.ground_z_ned - state.guidance.climb_to_z_ned);
    case RequestKind::kLand: {
      if (state.guidance.phase != Phase::kPath || state.mode != Mode::kLanding) return 0.0;
      const double top_z_ned = state.guidance.path.segment.z[0];
      return fraction(z_ned - top_z_ned, state.guidance.ground_z_ned - top_z_ned);
    }
    case RequestKind::kTrajectory:
      return context.plan.trajectory == nullptr
                 ? 0.0
                 : segments_progress(state, context.plan.trajectory->segments.size());
    case RequestKind::kMissionPause:
      return state.guidance.pause == MissionPause::kNone && context.paused()
                 ? fraction(elapsed_s(state.guidance.path.clock.change_ns, state.now_ns),
                            state.guidance.path.clock.change_s)
                 : path_progress(state);
    default:
      return is_of_mission(request.kind) ? mission_progress(context) : path_progress(state);
  }
}

bool reference_rests(const SupervisorState& state) {
  const TimeScaling& clock = state.guidance.path.clock;
  const bool stands = !clock.runs && !clock.is_changing(state.now_ns);
  return state.mode == Mode::kHolding && (stands || state.guidance.path.finished(state.now_ns));
}

bool is_at_reference(const Estimate& estimate, const Reference& reference) {
  return (estimate.position_ned - reference.position_ned).norm() < kThere_m &&
         estimate.velocity_ned.norm() < kStandstill_m_s;
}

bool ends_at_rest(RequestKind kind) {
  return kind == RequestKind::kTakeoff || kind == RequestKind::kGoTo || kind == RequestKind::kHold ||
         kind == RequestKind::kMissionPause;
}

// The change begins with the step after its acceptance.
void follow_gains(RequestStatus& request, double progress) {
  request.progress = std::max(request.progress, progress);
  if (progress >= 1.0) succeed(request);
}

}  // namespace

const char* to_string(RequestState state) {
  switch (state) {
    case RequestState::kUnknown:
      return "unknown";
    case RequestState::kAccepted:
      return "accepted";
    case RequestState::kExecuting:
      return "executing";
    case RequestState::kSucceeded:
      return "succeeded";
    case RequestState::kCanceled:
      return "canceled";
    case RequestState::kAborted:
      return "aborted";
  }
  return "unknown";
}

std::string result_of(const RequestStatus& request) {
  if (request.state == RequestState::kAborted) return std::string("aborted: ") + to_string(request.reason);
  if (request.state != RequestState::kCanceled) return "";
  if (request.ended_by == Event::kSetpoint) return "canceled by setpoints";
  return std::string("canceled by a newer request: ") + to_string(request.ended_by);
}

bool differ_in_state(const RequestStatuses& a, const RequestStatuses& b) {
  return !std::equal(a.begin(), a.end(), b.begin(), [](const RequestStatus& one, const RequestStatus& other) {
    return one.key == other.key && one.kind == other.kind && one.state == other.state;
  });
}

void note_accepted(SupervisorContext& context) {
  const Request& request = *context.request;
  const auto is_idle = [](const RequestStatus& known) { return !is_under_way(known); };
  RequestStatuses& known = context.state.requests;
  auto slot = std::find_if(known.begin(), known.end(), is_idle);
  if (slot == known.end()) slot = known.begin();
  std::rotate(slot, slot + 1, known.end());
  RequestStatus& added = known.back();
  added = {};
  added.key = request.key;
  added.kind = request.kind;
  added.state = RequestState::kAccepted;
  const bool obeyed = request.kind == RequestKind::kArm && context.inputs.not_obeyed_s == 0.0;
  const bool stands = request.kind == RequestKind::kLand && context.state.mode == Mode::kDisarmed;
  const bool at_once = request.kind == RequestKind::kSettings && rotors_off(context.state.mode);
  if (is_done_when_accepted(request.kind) || obeyed || stands || at_once) succeed(added);
}

void end_requests(SupervisorContext& context, const Transition& row) {
  const SupervisorState& state = context.state;
  for (RequestStatus& request : context.state.requests) {
    if (!is_under_way(request)) continue;
    if (is_of_mission(request.kind)) {
      end_with_mission(request, state.guidance.mission.state, row);
    } else {
      end_with_path(request, state.mode, row);
    }
  }
}

void follow_requests(SupervisorContext& context, const Reference& reference, bool progress_due) {
  for (RequestStatus& request : context.state.requests) {
    if (!is_under_way(request)) continue;
    const bool begins = request.state == RequestState::kAccepted;
    request.state = RequestState::kExecuting;
    if (request.kind == RequestKind::kArm) {
      if (context.inputs.not_obeyed_s == 0.0) succeed(request);
      continue;
    }
    if (request.kind == RequestKind::kSettings) {
      if (!begins) follow_gains(request, context.inputs.gains_progress);
      continue;
    }
    if (progress_due || begins) request.progress = std::max(request.progress, progress(request, context));
    if (ends_at_rest(request.kind) && reference_rests(context.state) &&
        is_at_reference(context.estimate(), reference))
      succeed(request);
  }
}

}  // namespace swiftlet::control

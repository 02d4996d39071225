#include "swiftlet/control/supervision/actions.hpp"

#include <algorithm>

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/control/guidance/spool_up.hpp"
#include "swiftlet/control/supervision/setpoint_path.hpp"

namespace swiftlet::control::actions {
namespace {

constexpr double kHoverTestSpeed = 0.2;  // m/s
constexpr double kApproachSpeed = 0.5;   // m/s, from rest to the start of a trajectory

void take_off(SupervisorContext& context) {
  start_takeoff(context.guidance(), context.request->position_ned.z(), context.request->speed,
                context.state.now_ns);
}

void take_off_to_test(SupervisorContext& context) {
  start_takeoff(context.guidance(), hover_test_top_ned(context).z(), kHoverTestSpeed, context.state.now_ns);
}

void keep_mission(SupervisorContext& context) {
  const Mission& mission = *context.request->mission;
  context.plan.mission = &mission;
  context.plan.mission_limits = tightened(context.settings.limits, mission.bounds);
  context.state.guidance.mission = {mission.id, MissionState::kUploaded, 0,
                                    static_cast<int>(mission.items.size())};
}

// The context of a request has the limits from before it. From here on the mission's limits apply.
void fly_mission(SupervisorContext& context, void (*begin)(SupervisorContext&)) {
  SupervisorContext flown{context.settings, context.plan.mission_limits,
                          context.inputs,   context.state,
                          context.plan,     context.request};
  flown.state.guidance.mission.state = MissionState::kRunning;
  begin(flown);
}

void start_mission(SupervisorContext& context) {
  context.state.guidance.mission.item_index = 0;
  fly_mission(context, [](SupervisorContext& flown) {
    start_item(flown.guidance(), std::max(flown.request->start_ns, flown.state.now_ns));
  });
}

void skip_item(SupervisorContext& context) {
  ++context.state.guidance.mission.item_index;
  fly_mission(context, [](SupervisorContext& flown) { start_item(flown.guidance(), flown.state.now_ns); });
}

void clear_mission(SupervisorContext& context) {
  const bool moves = context.paused() && context.state.guidance.pause == MissionPause::kNone;
  if (moves) start_stop(context.guidance());  // it cannot continue on its path
  context.plan.mission = nullptr;
  context.state.guidance.mission = {};
  context.state.guidance.pause = MissionPause::kNone;
}

// Stores the path of a paused mission, so that it can be resumed from elsewhere.
void store_path_if_paused(SupervisorContext& context) {
  if (context.paused()) pause_path(context.guidance());
}

void start_trajectory(SupervisorContext& context) {
  const Trajectory& trajectory = *context.request->trajectory;
  context.plan.trajectory = &trajectory;
  context.state.guidance.trajectory_id = trajectory.id;
  start_join(context.guidance(), trajectory.segments.front(), false,
             std::min(kApproachSpeed, context.limits.max_speed), context.state.now_ns);
}

void follow_setpoint(SupervisorContext& context) {
  const SetpointKind kind = context.setpoint->kind;
  if (goes_past_position(kind)) {
    take_direct(context.guidance(), *context.setpoint);
  } else {
    follow_path(context.guidance(), path_to_setpoint(context));
  }
  context.state.guidance.setpoint_kind = kind;
  context.state.guidance.setpoint_ns = context.state.now_ns;
}

void move(SupervisorContext& context) {
  store_path_if_paused(context);
  const Request& request = *context.request;
  start_move(context.guidance(), request.position_ned, request.yaw_free, request.yaw_rad, request.speed,
             context.state.now_ns);
}

void land_at(SupervisorContext& context, double speed) {
  start_landing(context.guidance(), speed, context.state.now_ns);
}

void land(SupervisorContext& context) { land_at(context, context.settings.failsafe.descent_speed); }

void begin_at_estimate(SupervisorContext& context) {
  Reference here = standing_at(context.estimate());
  here.velocity_ned = context.estimate().velocity_ned;
  context.state.guidance.path.pin(here);
}

}  // namespace

const Action kNothing{"", [](SupervisorContext&) {}};
const Action kNoteGround{"store the ground height", [](SupervisorContext& context) {
                           context.state.guidance.ground_z_ned = context.estimate().position_ned.z();
                         }};
const Action kTakeOff{"spool up, climb", take_off};
const Action kTakeOffToTest{"spool up, move a little, climb", take_off_to_test};
const Action kKeepMission{"store the mission", keep_mission};
const Action kStartMission{"start the first item", start_mission};
const Action kPause{"brake along the path",
                    [](SupervisorContext& context) { change_time_scaling(context.guidance(), false); }};
const Action kResume{"return to the paused path, then continue",
                     [](SupervisorContext& context) { return_to_paused_path(context.guidance()); }};
const Action kSkip{"start the next item", skip_item};
const Action kClearMission{"delete the mission; brake if still on its path", clear_mission};
const Action kStartTrajectory{"join the start of the trajectory", start_trajectory};
const Action kChangeGains{"change the gains over the requested time; at once with the rotors off",
                          [](SupervisorContext&) {}};
const Action kFollowSetpoint{"follow the setpoint", follow_setpoint};
const Action kMove{"move to the target", move};
const Action kStop{"brake to rest", [](SupervisorContext& context) {
                     store_path_if_paused(context);
                     start_stop(context.guidance());
                   }};
const Action kLandAsAsked{
    "land at the requested speed, `descent_speed` at most", [](SupervisorContext& context) {
      land_at(context, std::min(context.request->speed, context.settings.failsafe.descent_speed));
    }};
const Action kLand{"land at `descent_speed`", land};
const Action kLandFast{"land at `critical_descent_speed`", [](SupervisorContext& context) {
                         land_at(context, context.settings.failsafe.critical_descent_speed);
                       }};
const Action kHoldOnReturn{"hold once a pose is available",
                           [](SupervisorContext& context) { context.state.land_on_return = false; }};
const Action kLandOnReturn{"land once a pose is available",
                           [](SupervisorContext& context) { context.state.land_on_return = true; }};
const Action kStopFromEstimate{"brake to rest, from the estimate", [](SupervisorContext& context) {
                                 begin_at_estimate(context);
                                 start_stop(context.guidance());
                               }};
const Action kLandFromEstimate{"land at `descent_speed`, from the estimate", [](SupervisorContext& context) {
                                 begin_at_estimate(context);
                                 land(context);
                               }};

const Action kTakeIntoHold{"brake to rest, from the estimate; the ground is at z = 0",
                           [](SupervisorContext& context) {
                             context.state.guidance.ground_z_ned = 0.0;
                             context.state.guidance.airborne = true;
                             begin_at_estimate(context);
                             start_stop(context.guidance());
                           }};

}  // namespace swiftlet::control::actions

#include "swiftlet/control/supervision/actions.hpp"

#include <algorithm>

#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/control/supervision/setpoint_way.hpp"

namespace swiftlet::control::act {
namespace {

constexpr double kApproachSpeed = 0.5;  // m/s, from rest to where a trajectory begins

void take_off(Scene& scene) {
  start_takeoff(scene.guidance(), scene.request->position_ned.z(), scene.request->speed);
}

void keep_mission(Scene& scene) {
  const Mission& mission = *scene.request->mission;
  scene.plan.mission = &mission;
  scene.plan.mission_limits = tightened(scene.settings.limits, mission.bounds);
  scene.state.guidance.mission = {mission.id, MissionState::kUploaded, 0,
                                  static_cast<int>(mission.items.size())};
}

// The scene of a request has the limits of before it: of the mission, from here on.
void fly_mission(Scene& scene, void (*begin)(Scene&)) {
  Scene flown{scene.settings, scene.plan.mission_limits, scene.situation, scene.state, scene.plan,
              scene.request};
  flown.state.guidance.mission.state = MissionState::kRunning;
  begin(flown);
}

void start_mission(Scene& scene) {
  scene.state.guidance.mission.item_index = 0;
  fly_mission(scene, [](Scene& flown) { start_item(flown.guidance(), flown.state.now_ns); });
}

void skip_item(Scene& scene) {
  ++scene.state.guidance.mission.item_index;
  fly_mission(scene, [](Scene& flown) { start_item(flown.guidance(), flown.state.now_ns); });
}

void clear_mission(Scene& scene) {
  const bool moves = scene.paused() && scene.state.guidance.detour == Detour::kNone;
  if (moves) start_stop(scene.guidance());  // along its way it could not go on
  scene.plan.mission = nullptr;
  scene.state.guidance.mission = {};
  scene.state.guidance.detour = Detour::kNone;
}

// A mission that is paused can be gone on with from elsewhere.
void leave_way_if_paused(Scene& scene) {
  if (scene.paused()) leave_way(scene.guidance());
}

void start_trajectory(Scene& scene) {
  const Trajectory& trajectory = *scene.request->trajectory;
  scene.plan.trajectory = &trajectory;
  scene.state.guidance.trajectory_id = trajectory.id;
  start_join(scene.guidance(), trajectory.segments.front(), false,
             std::min(kApproachSpeed, scene.limits.max_speed), scene.state.now_ns);
}

void follow_setpoint(Scene& scene) {
  const SetpointKind kind = scene.setpoint->kind;
  if (goes_past_position(kind)) {
    take_direct(scene.guidance(), *scene.setpoint);
  } else {
    follow_way(scene.guidance(), way_into_setpoint(scene));
  }
  scene.state.guidance.setpoint_kind = kind;
  scene.state.guidance.setpoint_ns = scene.state.now_ns;
}

void move(Scene& scene) {
  leave_way_if_paused(scene);
  const Request& request = *scene.request;
  start_move(scene.guidance(), request.position_ned, request.yaw_free, request.yaw_rad, request.speed,
             scene.state.now_ns);
}

void land_at(Scene& scene, double speed) { start_landing(scene.guidance(), speed, scene.state.now_ns); }

void land(Scene& scene) { land_at(scene, scene.settings.failsafe.descent_speed); }

void begin_at_estimate(Scene& scene) {
  Reference here = standing_at(scene.estimate());
  here.velocity_ned = scene.estimate().velocity_ned;
  scene.state.guidance.path.pin(here);
}

}  // namespace

const Action kNothing{"", [](Scene&) {}};
const Action kNoteGround{"note where the ground is", [](Scene& scene) {
                           scene.state.guidance.ground_z_ned = scene.estimate().position_ned.z();
                         }};
const Action kTakeOff{"spool up, climb", take_off};
const Action kKeepMission{"keep it", keep_mission};
const Action kStartMission{"start its first item", start_mission};
const Action kPause{"come to rest on its way", [](Scene& scene) { turn_clock(scene.guidance(), false); }};
const Action kResume{"back to where it was left, and on",
                     [](Scene& scene) { return_to_way(scene.guidance()); }};
const Action kSkip{"start its next item", skip_item};
const Action kClearMission{"forget it; come to rest where it was flown", clear_mission};
const Action kStartTrajectory{"join it where it begins", start_trajectory};
const Action kFollowSetpoint{"follow it", follow_setpoint};
const Action kMove{"go there", move};
const Action kStop{"come to rest", [](Scene& scene) {
                     leave_way_if_paused(scene);
                     start_stop(scene.guidance());
                   }};
const Action kLandAsAsked{"land at the speed asked for, `descent_speed` at most", [](Scene& scene) {
                            land_at(scene,
                                    std::min(scene.request->speed, scene.settings.failsafe.descent_speed));
                          }};
const Action kLand{"land at `descent_speed`", land};
const Action kLandFast{"land at `critical_descent_speed`",
                       [](Scene& scene) { land_at(scene, scene.settings.failsafe.critical_descent_speed); }};
const Action kHoldOnReturn{"hold when the pose is back",
                           [](Scene& scene) { scene.state.land_on_return = false; }};
const Action kLandOnReturn{"land when the pose is back",
                           [](Scene& scene) { scene.state.land_on_return = true; }};
const Action kStopFromEstimate{"come to rest, from the estimate", [](Scene& scene) {
                                 begin_at_estimate(scene);
                                 start_stop(scene.guidance());
                               }};
const Action kLandFromEstimate{"land at `descent_speed`, from the estimate", [](Scene& scene) {
                                 begin_at_estimate(scene);
                                 land(scene);
                               }};

const Action kTakeIntoHold{"come to rest, from the estimate; the ground is at z = 0", [](Scene& scene) {
                             scene.state.guidance.ground_z_ned = 0.0;
                             scene.state.guidance.airborne = true;
                             begin_at_estimate(scene);
                             start_stop(scene.guidance());
                           }};

}  // namespace swiftlet::control::act

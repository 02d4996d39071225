#include "swiftlet/control/supervision/guards.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/supervision/arming.hpp"
#include "swiftlet/control/supervision/conditions.hpp"
#include "swiftlet/control/supervision/setpoint_path.hpp"
#include "swiftlet/control/types/gains.hpp"

namespace swiftlet::control {
namespace {

constexpr double kLeastClimb_m = 2.0 * kAirborneHeight_m;
constexpr double kLongestWaitForStart_s = 60.0;
constexpr double kMaxSetpointStep_m = 1.0;
constexpr double kUnitTolerance = 1e-3;
constexpr double kDetectionDelay_s = 0.01;  // delay until a stream time-out is detected: the next IMU sample
constexpr double kRounding = 1e-9;
// Gains change only in calm flight: the rotors have not saturated for kCalm_s, tilt and body rate are below
// kCalmFraction of their limits, and the vehicle is within kCalmError_m of its reference.
constexpr double kCalm_s = 0.5;
constexpr double kCalmFraction = 0.5;
constexpr double kCalmError_m = 0.2;

GroundLinkAction link_action(const SupervisorContext& context) {
  return context.settings.failsafe.ground_link_action;
}

// In take-off, still on the ground. Where lift-off is observed, the reference rises from then on (advance_spool_up()).
bool spooling_up(const SupervisorContext& context) {
  const GuidanceState& guidance = context.state.guidance;
  return guidance.phase == Phase::kSpoolUp && !guidance.path.moving;
}

Outcome battery_sufficient(const SupervisorContext& context) {
  const SupervisorInputs& inputs = context.inputs;
  const double limit = context.settings.failsafe.low_battery_voltage;
  if (inputs.supply_voltage_v >= limit) return accept();
  return refuse("battery voltage %.2f V is too low to take off; minimum is %.2f V", inputs.supply_voltage_v,
                limit);
}

// A take-off ends above the ground, and at the minimum height or above.
Outcome check_takeoff_height(const char* what, double z_ned, const SupervisorContext& context) {
  const double ground_z_ned = context.state.guidance.ground_z_ned;
  const double least_m = std::max(context.limits.min_height_m, kLeastClimb_m - ground_z_ned);
  if (!(-z_ned < least_m - kRounding)) return accept();
  return refuse("%s: height %.2f m is too low; minimum is %.2f m", what, -z_ned, least_m);
}

Outcome check_takeoff(const SupervisorContext& context) {
  const Request& request = *context.request;
  const Limits& limits = context.limits;
  Outcome outcome = battery_sufficient(context);
  if (!outcome.accepted) return outcome;
  outcome = check_speed("takeoff", request.speed, limits);
  if (!outcome.accepted) return outcome;
  Eigen::Vector3d top = context.estimate().position_ned;
  top.z() = request.position_ned.z();
  // Below the ground, the sign is explained first.
  if (top.z() > 0.0) outcome = check_position("takeoff", top, limits);
  if (outcome.accepted) outcome = check_takeoff_height("takeoff", top.z(), context);
  return outcome.accepted ? check_position("takeoff", top, limits) : outcome;
}

Outcome check_hover_test(const SupervisorContext& context) {
  const Outcome battery = battery_sufficient(context);
  if (!battery.accepted) return battery;
  return check_position("hover test", hover_test_top_ned(context), context.limits);
}

Outcome check_upload(const SupervisorContext& context) {
  const Mission* const mission = context.request->mission;
  if (mission == nullptr || mission->items.empty()) return refuse("the mission has no items");
  return accept();
}

// The request names the uploaded mission, or none.
Outcome check_mission_named(const SupervisorContext& context) {
  const MissionProgress& there = context.state.guidance.mission;
  const std::uint64_t asked = context.request->mission_id;
  if (context.plan.mission == nullptr) return refuse("no mission is uploaded; upload one first");
  if (asked == 0 || asked == there.id) return accept();
  return refuse("mission %llu is not uploaded; the uploaded mission is %llu",
                static_cast<unsigned long long>(asked), static_cast<unsigned long long>(there.id));
}

// The vehicle is inside the mission's fence, within the failsafe's margin, and so is the landing point.
Outcome check_mission_fence(const SupervisorContext& context) {
  const Limits& limits = context.plan.mission_limits;
  const double margin_m = context.settings.failsafe.fence_margin_m;
  Eigen::Vector3d at = context.estimate().position_ned;
  if (beyond_fence(limits, at) > margin_m) return check_inside_fence("the vehicle", at, limits);
  if (context.plan.mission->items.back().kind != MissionItemKind::kLand) return accept();
  at.z() = context.state.guidance.ground_z_ned;
  if (beyond_fence(limits, at) > margin_m) return check_inside_fence("the landing point", at, limits);
  return accept();
}

// A start in the future: the reference rests until then.
Outcome check_start_time(const SupervisorContext& context) {
  const Request& request = *context.request;
  if (request.start_ns == 0) return accept();
  const double ahead_s = elapsed_s(context.state.now_ns, request.start_ns);
  if (!(ahead_s >= 0.0)) return refuse("mission start: the start time was %.3f s ago", -ahead_s);
  if (ahead_s > kLongestWaitForStart_s)
    return refuse("mission start: the start time is %.1f s ahead, the limit is %.0f s", ahead_s,
                  kLongestWaitForStart_s);
  // On the ground the path is that of the last landing, which a touchdown cut short.
  const GuidanceState& guidance = context.state.guidance;
  if (!guidance.flying() || guidance.path.finished(context.state.now_ns)) return accept();
  return refuse("mission start: the vehicle still moves; at a given time it can start from rest only");
}

Outcome check_start(const SupervisorContext& context) {
  const Outcome named = check_mission_named(context);
  if (!named.accepted) return named;
  const Outcome time = check_start_time(context);
  return time.accepted ? check_mission_fence(context) : time;
}

Outcome check_start_from_ground(const SupervisorContext& context) {
  const Outcome start = check_start(context);
  if (!start.accepted) return start;
  const Outcome battery = battery_sufficient(context);
  if (!battery.accepted) return battery;
  const MissionItem& first = context.plan.mission->items.front();
  if (first.kind != MissionItemKind::kTakeoff)
    return refuse("the vehicle stands on the ground; the mission must begin with a takeoff");
  return check_takeoff_height("item 1: takeoff", first.position_ned.z(), context);
}

Outcome check_skip(const SupervisorContext& context) {
  const Outcome named = check_mission_named(context);
  if (!named.accepted) return named;
  const MissionProgress& there = context.state.guidance.mission;
  if (there.item_index + 1 < there.item_count) return accept();
  return refuse("item %d is the last of the mission; there is no item to skip to", there.item_count);
}

// If no mission is uploaded, there is nothing to clear.
Outcome check_clear(const SupervisorContext& context) {
  return context.plan.mission == nullptr && context.request->mission_id == 0 ? accept()
                                                                             : check_mission_named(context);
}

Outcome check_trajectory(const SupervisorContext& context) {
  const Trajectory* trajectory = context.request->trajectory;
  if (trajectory == nullptr || trajectory->segments.empty()) return refuse("the trajectory has no segments");
  const Reference start = evaluate(trajectory->segments.front(), 0.0);
  return check_position("trajectory", start.position_ned, context.limits);
}

Outcome check_feed_forward(const Setpoint& setpoint, const Limits& limits) {
  if (!setpoint.velocity_ned.allFinite() || !setpoint.acceleration_ned.allFinite() ||
      !std::isfinite(setpoint.yaw_rad) || !std::isfinite(setpoint.yaw_rate)) {
    return refuse("setpoint: a value is not a finite number");
  }
  const double speed = setpoint.velocity_ned.norm();
  if (speed > limits.max_speed)
    return refuse("setpoint: speed is %.2f m/s, the limit is %.2f m/s", speed, limits.max_speed);
  const double acceleration = setpoint.acceleration_ned.norm();
  if (acceleration > limits.max_acceleration) {
    return refuse("setpoint: acceleration is %.2f m/s^2, the limit is %.2f m/s^2", acceleration,
                  limits.max_acceleration);
  }
  if (std::abs(setpoint.yaw_rate) <= limits.max_yaw_rate) return accept();
  return refuse("setpoint: yaw rate is %.2f rad/s, the limit is %.2f rad/s", setpoint.yaw_rate,
                limits.max_yaw_rate);
}

Outcome check_position_setpoint(const SupervisorContext& context) {
  const Setpoint& setpoint = *context.setpoint;
  const Outcome position = check_position("setpoint", setpoint.position_ned, context.limits);
  if (!position.accepted) return position;
  const double step = (setpoint.position_ned - context.estimate().position_ned).norm();
  if (step <= kMaxSetpointStep_m) return accept();
  return refuse("setpoint: %.2f m away from the vehicle, the limit is %.2f m", step, kMaxSetpointStep_m);
}

// This setpoint may be the last: the reference then continues for the time-out, and brakes to rest.
Outcome check_end_of_stream(const SupervisorContext& context) {
  const Setpoint& setpoint = *context.setpoint;
  const Limits& limits = context.limits;
  const double timeout_s = context.settings.failsafe.setpoint_timeout_s + kDetectionDelay_s;
  Reference last;
  if (setpoint.kind == SetpointKind::kPosition) {
    last.velocity_ned = setpoint.velocity_ned;
    last.position_ned = setpoint.position_ned + timeout_s * setpoint.velocity_ned;
  } else {
    const Reference from = reference_on_path(context.guidance(), context.state.now_ns);
    last = after_blend(path_to_setpoint(context), timeout_s);
    // Prevents a stream that was stopped before the fence from creeping towards it in short moves from rest.
    Reference in_full_motion;
    in_full_motion.velocity_ned =
        setpoint.kind == SetpointKind::kVelocity ? setpoint.velocity_ned : last.velocity_ned;
    in_full_motion.position_ned = from.position_ned + timeout_s * in_full_motion.velocity_ned;
    const Outcome inside =
        check_position("setpoint: stopping point", brake_reference(limits, in_full_motion).place_ned, limits);
    if (!inside.accepted) return inside;
  }
  const double speed = last.velocity_ned.norm();
  if (speed > limits.max_speed + kRounding) {
    return refuse("setpoint: speed reaches %.2f m/s within %.2f s, the limit is %.2f m/s", speed, timeout_s,
                  limits.max_speed);
  }
  return check_position("setpoint: stopping point", brake_reference(limits, last).place_ned, limits);
}

Outcome check_thrust(const Setpoint& setpoint, const Limits& limits) {
  const double most = plant::kGravity + limits.max_acceleration;
  if (setpoint.specific_thrust >= 0.0 && setpoint.specific_thrust <= most) return accept();
  return refuse("setpoint: thrust is %.2f m/s^2, must be at least 0 and at most %.2f m/s^2",
                setpoint.specific_thrust, most);
}

Outcome check_rates(const Setpoint& setpoint, const Limits& limits) {
  const double rate = setpoint.body_rates_frd.norm();
  if (rate <= limits.max_body_rate) return accept();
  return refuse("setpoint: body rate is %.2f rad/s, the limit is %.2f rad/s", rate, limits.max_body_rate);
}

Outcome check_attitude(const Setpoint& setpoint, const Limits& limits) {
  if (!(std::abs(setpoint.q_ned_from_frd.norm() - 1.0) <= kUnitTolerance))
    return refuse("setpoint: the attitude is not a unit quaternion");
  const double tilt = std::acos(std::clamp(cosine_of_tilt(setpoint.q_ned_from_frd), -1.0, 1.0));
  if (tilt <= limits.max_tilt_rad) return accept();
  return refuse("setpoint: tilt is %.2f rad, the limit is %.2f rad", tilt, limits.max_tilt_rad);
}

// Attitudes and body rates have no position: the fence check uses the vehicle's own motion.
Outcome check_direct_setpoint(const SupervisorContext& context) {
  const Setpoint& setpoint = *context.setpoint;
  const Limits& limits = context.limits;
  if (context.inputs.level == plant::ControlLevel::kTrajectory)
    return refuse("setpoint: a vehicle that is commanded at level trajectory follows no %s",
                  setpoint.kind == SetpointKind::kAttitude ? "attitudes" : "body rates");
  if (context.state.mode == Mode::kHolding && context.state.reason == Reason::kSetpointsViolatedFence)
    return refuse(
        "setpoint: the stream violated the fence; send hold or goto before more setpoints of its kind");
  const Outcome rates = check_rates(setpoint, limits);
  if (!rates.accepted) return rates;
  const Outcome thrust = check_thrust(setpoint, limits);
  if (!thrust.accepted) return thrust;
  if (setpoint.kind == SetpointKind::kAttitude) {
    const Outcome attitude = check_attitude(setpoint, limits);
    if (!attitude.accepted) return attitude;
  }
  return violates_fence(context.guidance())
             ? refuse("setpoint: the vehicle cannot come to rest inside the fence and above %.3f m",
                      limits.min_height_m)
             : accept();
}

Outcome check_setpoint(const SupervisorContext& context) {
  const Setpoint& setpoint = *context.setpoint;
  if (setpoint.kind > SetpointKind::kBodyRates)
    return refuse("setpoint: unknown kind %d", static_cast<int>(setpoint.kind));
  if (goes_past_position(setpoint.kind)) return check_direct_setpoint(context);
  const Outcome numbers = check_feed_forward(setpoint, context.limits);
  if (!numbers.accepted) return numbers;
  if (setpoint.kind == SetpointKind::kPosition) {
    const Outcome position = check_position_setpoint(context);
    if (!position.accepted) return position;
  }
  return check_end_of_stream(context);
}

Outcome check_goto(const SupervisorContext& context) {
  const Request& request = *context.request;
  const Outcome position = check_position("goto", request.position_ned, context.limits);
  if (!position.accepted) return position;
  const Outcome speed = check_speed("goto", request.speed, context.limits);
  if (!speed.accepted) return speed;
  return request.yaw_free ? accept() : check_yaw("goto", request.yaw_rad);
}

// The mission takes off or lands.
bool near_ground_in_mission(const SupervisorContext& context) {
  if (context.state.mode != Mode::kMission || context.plan.mission == nullptr) return false;
  const auto item = static_cast<std::size_t>(context.state.guidance.mission.item_index);
  return context.plan.mission->items[item].kind == MissionItemKind::kTakeoff ||
         on_landing_item(context.guidance());
}

Outcome check_calm(const SupervisorContext& context) {
  const Estimate& estimate = context.estimate();
  if (pose_lost(context.inputs, context.settings.failsafe))
    return refuse("cannot change the gains without a mocap pose");
  if (context.inputs.unsaturated_s < kCalm_s)
    return refuse("cannot change the gains: the rotors were saturated %.2f s ago, must be at least %.1f s",
                  context.inputs.unsaturated_s, kCalm_s);
  const double tilt = std::acos(std::clamp(cosine_of_tilt(estimate.q_ned_from_frd), -1.0, 1.0));
  const double most_tilt = kCalmFraction * context.settings.limits.max_tilt_rad;
  if (!(tilt <= most_tilt))
    return refuse("cannot change the gains: the tilt is %.2f rad, must be at most %.2f rad", tilt, most_tilt);
  const double rate = estimate.body_rates_frd.norm();
  const double most_rate = kCalmFraction * context.settings.limits.max_body_rate;
  if (!(rate <= most_rate))
    return refuse("cannot change the gains: the body rate is %.2f rad/s, must be at most %.2f rad/s", rate,
                  most_rate);
  const Reference reference = context.state.guidance.path.at(context.state.now_ns);
  const double error_m = (estimate.position_ned - reference.position_ned).norm();
  if (error_m <= kCalmError_m) return accept();
  return refuse("cannot change the gains: the vehicle is %.2f m off its reference, must be at most %.2f m",
                error_m, kCalmError_m);
}

Outcome check_settings(const SupervisorContext& context) {
  const GainChange* const change = context.request->gains;
  if (change == nullptr) return refuse("the request has no gains");
  if (context.inputs.gains_changing_s > 0.0)
    return refuse("the gains are still changing, for another %.1f s", context.inputs.gains_changing_s);
  if (context.inputs.gains != nullptr && *context.inputs.gains != change->from)
    return refuse("another request changed the gains meanwhile; send this one again");
  if (rotors_off(context.state.mode) || context.state.mode == Mode::kArmed) return accept();
  if (near_ground_in_mission(context))
    return refuse("cannot change the gains while the mission takes off or lands");
  if (context.state.mode == Mode::kSetpoint && goes_past_position(context.state.guidance.setpoint_kind))
    return refuse("cannot change the gains during setpoints of attitude or body rates");
  return check_calm(context);
}

}  // namespace

namespace guards {

const Guard kAlways{"", [](const SupervisorContext&) { return true; }};
const Guard kAirborne{"off the ground",
                      [](const SupervisorContext& context) { return context.state.guidance.airborne; }};
const Guard kInHoverTest{"in a hover test",
                         [](const SupervisorContext& context) { return in_hover_test(context.state); }};
const Guard kAirborneInHoverTest{"off the ground, in a hover test", [](const SupervisorContext& context) {
                                   return context.state.guidance.airborne && in_hover_test(context.state);
                                 }};
const Guard kSpoolingUp{"on the ground",
                        [](const SupervisorContext& context) { return spooling_up(context); }};
const Guard kLiftedOff{"lifted off", [](const SupervisorContext& context) { return !spooling_up(context); }};
const Guard kOnLandingItem{"on the landing item", [](const SupervisorContext& context) {
                             return on_landing_item(context.guidance());
                           }};
const Guard kPausable{"climbing or later, not on the landing item", [](const SupervisorContext& context) {
                        return context.state.guidance.phase != Phase::kSpoolUp &&
                               !on_landing_item(context.guidance());
                      }};
const Guard kPaused{"a mission is paused", [](const SupervisorContext& context) { return context.paused(); }};
const Guard kNotPaused{"no mission is paused",
                       [](const SupervisorContext& context) { return !context.paused(); }};
const Guard kNoneUnderWay{"no mission is flown or paused", [](const SupervisorContext& context) {
                            return !is_under_way(context.state.guidance.mission.state);
                          }};
const Guard kNoneFlown{"no mission is flown", [](const SupervisorContext& context) {
                         return context.state.guidance.mission.state != MissionState::kRunning;
                       }};
const Guard kWasLanding{"was landing",
                        [](const SupervisorContext& context) { return context.state.land_on_return; }};
const Guard kNotHurrying{"unless already landing for it", [](const SupervisorContext& context) {
                           return context.state.mode != Mode::kLanding ||
                                  context.state.reason != Reason::kBatteryCritical;
                         }};
const Guard kLinkHolds{"`ground_link_action: hold`", [](const SupervisorContext& context) {
                         return link_action(context) == GroundLinkAction::kHold;
                       }};
const Guard kLinkLands{"`ground_link_action: land`", [](const SupervisorContext& context) {
                         return link_action(context) == GroundLinkAction::kLand;
                       }};
const Guard kLinkMatters{"unless `ground_link_action: none`", [](const SupervisorContext& context) {
                           return link_action(context) != GroundLinkAction::kNone;
                         }};

const Guard kLinkMattersOnGround{"on the ground, unless `ground_link_action: none`",
                                 [](const SupervisorContext& context) {
                                   return kLinkMatters.holds(context) && kSpoolingUp.holds(context);
                                 }};

}  // namespace guards

namespace preconditions {

const Precondition kNone{"", [](const SupervisorContext&) { return accept(); }};
const Precondition kArming{"all arming checks pass", check_arming};
const Precondition kTakeoff{"battery voltage, speed, target above the ground and inside the fence",
                            check_takeoff};
const Precondition kHoverTest{"battery voltage, a fence that is high enough", check_hover_test};
const Precondition kUpload{"the mission has items", check_upload};
const Precondition kStartFromGround{
    "a mission is uploaded, start time, battery voltage, inside its fence, first item a takeoff to above the "
    "ground",
    check_start_from_ground};
const Precondition kStart{"a mission is uploaded, start time, inside its fence", check_start};
const Precondition kNamed{"the mission id matches", check_mission_named};
const Precondition kSkip{"the mission id matches, another item follows", check_skip};
const Precondition kClear{"the mission id matches, or no mission is uploaded", check_clear};
const Precondition kTrajectory{"starts inside the fence", check_trajectory};
const Precondition kSetpoint{"inside the fence with room to stop, within the limits, near the vehicle",
                             check_setpoint};
const Precondition kGoTo{"inside the fence, within the limits", check_goto};
const Precondition kLand{"speed within the limit", [](const SupervisorContext& context) {
                           return check_speed("land", context.request->speed, context.limits);
                         }};

const Precondition kSettings{
    "stable gains; no other change of gains under way; on the ground, or in calm flight with a pose",
    check_settings};
const Precondition kPose{"a pose is available", [](const SupervisorContext& context) {
                           if (!pose_lost(context.inputs, context.settings.failsafe)) return accept();
                           return refuse("cannot engage in flight without a mocap pose");
                         }};

}  // namespace preconditions
}  // namespace swiftlet::control

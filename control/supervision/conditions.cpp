#include "swiftlet/control/supervision/conditions.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/guidance/manoeuvres.hpp"
#include "swiftlet/control/guidance/setpoint_stream.hpp"
#include "swiftlet/math/time.hpp"

namespace swiftlet::control {
namespace {

constexpr double kContactDepth_m = 0.05;  // the reference is this far below the vehicle ...
constexpr double kContactSpeed = 0.05;    // ... and the vehicle is at rest, or slides at ground height
constexpr double kContactTime_s = 0.2;
constexpr double kContactLift = 1.0;  // m/s^2, vertical specific-force residual for kBlindContactTime_s
constexpr double kBlindContactTime_s = 0.3;
constexpr double kVehicleFaultTime_s = 0.5;
constexpr double kObeyTime_s = 1.0;  // from arming, or a takeover, until the vehicle reports that it obeys
constexpr double kStandsBelow_m = 0.3;
constexpr double kStandsTime_s = 3.0;
constexpr double kMostOfClimb = 0.9;
constexpr double kHoverTest_s = 2.0;
constexpr double kRotorsStartTime_s =
    10.0;  // PX4 disarms after this time without a take-off (COM_DISARM_PRFLT)

// True once `condition` has held for `duration_s`. `since` is when it began, or 0 if it does not hold.
bool held(bool condition, std::int64_t& since, std::int64_t now_ns, double duration_s) {
  if (!condition) {
    since = 0;
    return false;
  }
  if (since == 0) since = now_ns;
  return elapsed_s(since, now_ns) >= duration_s;
}

bool touchdown_detected(SupervisorContext& context) {
  SupervisorState& state = context.state;
  if (state.mode == Mode::kDescent) {
    return held(context.inputs.vertical_specific_force_residual > kContactLift, state.contact_since_ns,
                state.now_ns, kBlindContactTime_s);
  }
  if (state.guidance.phase != Phase::kSink) {
    state.contact_since_ns = 0;
    return false;
  }
  const Estimate& estimate = context.estimate();
  const double depth = state.guidance.path.at(state.now_ns).position_ned.z() - estimate.position_ned.z();
  const bool at_ground = estimate.position_ned.z() > state.guidance.ground_z_ned - kAirborneHeight_m;
  const double speed = at_ground ? std::abs(estimate.velocity_ned.z()) : estimate.velocity_ned.norm();
  return held(depth > kContactDepth_m && speed < kContactSpeed, state.contact_since_ns, state.now_ns,
              kContactTime_s);
}

// The reference climbed long ago, and the vehicle stands. An autopilot may take seconds to let its rotors lift.
bool no_lift_off(const SupervisorContext& context) {
  const SupervisorState& state = context.state;
  const GuidanceState& guidance = state.guidance;
  if (guidance.airborne || guidance.phase != Phase::kPath) return false;
  const double climb_m = guidance.ground_z_ned - guidance.climb_to_z_ned;
  const std::int64_t then_ns = state.now_ns - math::nanoseconds(kStandsTime_s);
  if (elapsed_s(state.mode_since_ns, then_ns) < 0.0) return false;
  const double risen_m = guidance.ground_z_ned - guidance.path.at(then_ns).position_ned.z();
  return risen_m > std::min(kStandsBelow_m, kMostOfClimb * climb_m) &&
         context.estimate().velocity_ned.norm() < kContactSpeed;
}

bool outside_fence(const SupervisorContext& context) {
  return beyond_fence(context.limits, context.estimate().position_ned) >
         context.settings.failsafe.fence_margin_m;
}

void observe_battery(SupervisorContext& context, EventSet& events) {
  const FailsafeSettings& failsafe = context.settings.failsafe;
  const SupervisorInputs& inputs = context.inputs;
  SupervisorState& state = context.state;
  const auto below = [&](double voltage_v, std::int64_t& since) {
    return held(inputs.has_battery && inputs.supply_voltage_v < voltage_v, since, state.now_ns,
                failsafe.battery_delay_s);
  };
  events.add(Event::kBatteryLow, below(failsafe.low_battery_voltage, state.low_battery_since_ns));
  events.add(Event::kBatteryCritical,
             below(failsafe.critical_battery_voltage, state.critical_battery_since_ns));
  events.add(Event::kBatterySilent, inputs.battery_age_s > failsafe.battery_timeout_s);
}

bool is_silent(const GroundLink& link, std::int64_t now_ns, double timeout_s) {
  return link.client != 0 && elapsed_s(link.heard_ns, now_ns) > timeout_s;
}

}  // namespace

double beyond_fence(const Limits& limits, const Eigen::Vector3d& position_ned) {
  return std::max((position_ned - limits.fence_max_ned).maxCoeff(),
                  (limits.fence_min_ned - position_ned).maxCoeff());
}

bool pose_lost(const SupervisorInputs& inputs, const FailsafeSettings& failsafe) {
  return !inputs.has_estimate || inputs.pose_age_s > failsafe.mocap_timeout_s;
}

bool ground_link_lost(const SupervisorState& state, const FailsafeSettings& failsafe) {
  return std::any_of(state.ground_links.begin(), state.ground_links.end(), [&](const GroundLink& link) {
    return is_silent(link, state.now_ns, failsafe.ground_link_timeout_s);
  });
}

void forget_silent_ground_links(SupervisorState& state, const FailsafeSettings& failsafe) {
  for (GroundLink& link : state.ground_links) {
    if (is_silent(link, state.now_ns, failsafe.ground_link_timeout_s)) link = GroundLink();
  }
}

double tip_over_cosine(const FailsafeSettings& failsafe) {
  return std::cos(std::min(failsafe.tip_over_tilt_rad, M_PI));
}

EventSet observe(SupervisorContext& context, double tip_over_cosine) {
  const FailsafeSettings& failsafe = context.settings.failsafe;
  const SupervisorInputs& inputs = context.inputs;
  SupervisorState& state = context.state;
  const bool lost = pose_lost(inputs, failsafe);
  EventSet events;
  events.add(Event::kVehicleRestarted, inputs.vehicle_restarted);
  events.add(Event::kImuUnusable, inputs.imu_unusable_s >= failsafe.imu_timeout_s);
  events.add(Event::kImuGap, inputs.imu_gap_s > failsafe.imu_gap_s);
  events.add(Event::kTippedOver, cosine_of_tilt(context.estimate().q_ned_from_frd) < tip_over_cosine);
  events.add(Event::kVehicleFault, inputs.vehicle_fault_s >= kVehicleFaultTime_s);
  events.add(Event::kRotorsNotRunning,
             !inputs.rotors_running && elapsed_s(state.mode_since_ns, state.now_ns) > kRotorsStartTime_s);
  events.add(Event::kNotObeyed,
             inputs.not_obeyed_s > kObeyTime_s && elapsed_s(state.mode_since_ns, state.now_ns) > kObeyTime_s);
  events.add(Event::kNoLiftOff, no_lift_off(context));
  events.add(Event::kHoverTestFailed, inputs.hover_test_defect[0] != '\0');
  events.add(Event::kHoverTestPassed, state.reason == Reason::kHoverTest && state.mode == Mode::kHolding &&
                                          elapsed_s(state.mode_since_ns, state.now_ns) > kHoverTest_s);
  events.add(Event::kImpact, state.guidance.phase != Phase::kGround &&
                                 inputs.specific_force_frd.norm() > failsafe.impact_acceleration);
  events.add(Event::kTakeoffInconsistent,
             inputs.takeoff_inconsistent && state.guidance.phase == Phase::kPath);
  events.add(Event::kPoseJumped, inputs.pose_jumped);
  events.add(Event::kPoseLost, lost);
  events.add(Event::kPoseIsBack, !lost);
  events.add(Event::kTouchdown, touchdown_detected(context));
  events.add(Event::kDescentTimedOut,
             state.mode == Mode::kDescent &&
                 elapsed_s(state.mode_since_ns, state.now_ns) > failsafe.descent_timeout_s);
  observe_battery(context, events);
  events.add(Event::kOutsideFence, !lost && outside_fence(context));
  events.add(Event::kGroundLinkLost, ground_link_lost(state, failsafe));
  events.add(Event::kSetpointsViolateFence, state.mode == Mode::kSetpoint &&
                                                goes_past_position(state.guidance.setpoint_kind) &&
                                                violates_fence(context.guidance()));
  events.add(Event::kSetpointsStopped,
             state.mode == Mode::kSetpoint &&
                 elapsed_s(state.guidance.setpoint_ns, state.now_ns) > failsafe.setpoint_timeout_s);
  events.add(Event::kPlanFinished, plan_finished(context.guidance()));
  return events;
}

}  // namespace swiftlet::control

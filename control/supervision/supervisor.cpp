#include "control/supervision/supervisor.hpp"

#include <algorithm>
#include <cmath>

#include "control/supervision/checks.hpp"

namespace swiftlet::control {
namespace {

constexpr double kSpoolUp_s = 0.8;
constexpr double kSpoolUpLift = 0.95;  // of the weight, at the end of the spool-up
constexpr double kAirborneHeight_m = 0.03;
constexpr double kFlareHeight_m = 0.08;   // the landing's planned path ends here, then it sinks
constexpr double kSinkSpeed = 0.15;       // m/s
constexpr double kContactDepth_m = 0.05;  // reference this far below the vehicle ...
constexpr double kContactSpeed = 0.05;    // ... which does not move: it stands
constexpr double kContactTime_s = 0.2;
constexpr double kContactLift = 1.0;  // m/s^2 of lift that the rotors do not explain, for kBlindContactTime_s
constexpr double kBlindContactTime_s = 0.3;
constexpr double kLowBatteryTime_s = 1.0;
constexpr double kArmTilt_rad = 0.35;
constexpr double kArmSpeed = 0.3;       // m/s
constexpr double kFenceMargin_m = 0.5;  // this far outside the fence it lands
constexpr double kMinMove_s = 0.5;

double seconds(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }
std::int64_t nanoseconds(double s) { return static_cast<std::int64_t>(std::llround(s * 1e9)); }

double yaw_of(const Eigen::Quaterniond& q) {
  return std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()), 1.0 - 2.0 * (q.y() * q.y() + q.z() * q.z()));
}

double cosine_of_tilt(const Eigen::Quaterniond& q) { return 1.0 - 2.0 * (q.x() * q.x() + q.y() * q.y()); }

// The yaw that is `to` plus whole turns, nearest to `from`.
double nearest_turn(double to, double from) { return from + std::remainder(to - from, 2.0 * M_PI); }

// True once `condition` has held for `duration_s`; `since` keeps when it began (0: it does not hold).
bool held(bool condition, std::int64_t& since, std::int64_t now_ns, double duration_s) {
  if (!condition) {
    since = 0;
    return false;
  }
  if (since == 0) since = now_ns;
  return seconds(now_ns - since) >= duration_s;
}

Reference standing_at(const Estimate& estimate) {
  Reference reference;
  reference.position_ned = estimate.position_ned;
  reference.yaw_rad = yaw_of(estimate.q_ned_from_frd);
  return reference;
}

}  // namespace

Supervisor::Supervisor(const Limits& limits, const FailsafeSettings& failsafe)
    : limits_(limits),
      failsafe_(failsafe),
      tip_over_cosine_(std::cos(std::min(failsafe.tip_over_tilt_rad, M_PI))) {}

Directive Supervisor::step(const Situation& situation) {
  state_.now_ns = situation.stamp_ns;
  if (state_.mode != Mode::kDisarmed && state_.mode != Mode::kStopped) check_failsafes(situation);
  if (state_.mode == Mode::kDescent) {
    const bool standing = held(situation.unexplained_lift > kContactLift, state_.contact_since_ns,
                               state_.now_ns, kBlindContactTime_s);
    if (standing)
      touch_down(Reason::kLandedWithoutPosition);
    else if (seconds(state_.now_ns - state_.mode_since_ns) > failsafe_.descent_timeout_s) {
      enter(Mode::kStopped, Reason::kDescentTimedOut);
    }
  } else if (flying()) {
    advance_phase(situation);
  }
  return directive(situation);
}

void Supervisor::enter(Mode mode, Reason reason) {
  if (state_.mission.state == MissionState::kRunning && mode != Mode::kMission)
    state_.mission.state = MissionState::kAborted;
  state_.mode = mode;
  state_.reason = reason;
  state_.mode_since_ns = state_.now_ns;
  state_.contact_since_ns = 0;
  if (mode == Mode::kDisarmed || mode == Mode::kStopped || mode == Mode::kArmed) {
    state_.phase = Phase::kGround;
    state_.airborne = false;
  }
  if (mode != Mode::kMission) mission_ = nullptr;
  if (mode != Mode::kTrajectory) trajectory_ = nullptr;
}

void Supervisor::check_failsafes(const Situation& situation) {
  const Estimate& estimate = *situation.estimate;
  const bool pose_lost = !situation.has_estimate || situation.pose_age_s > failsafe_.mocap_timeout_s;
  if (!situation.imu_healthy) return enter(Mode::kStopped, Reason::kImuUnusable);
  if (cosine_of_tilt(estimate.q_ned_from_frd) < tip_over_cosine_)
    return enter(Mode::kStopped, Reason::kTippedOver);
  if (state_.mode == Mode::kDescent) {
    if (!pose_lost) {
      enter(Mode::kHolding, Reason::kPoseIsBack);
      stop_from(estimate);
    }
    return;
  }
  if (pose_lost) {
    if (!flying()) return enter(Mode::kDisarmed, Reason::kNoPose);
    return enter(Mode::kDescent, Reason::kNoPose);
  }
  if (!flying() || state_.mode == Mode::kLanding) return;

  const bool low = situation.has_battery && situation.supply_voltage_v < failsafe_.low_battery_voltage;
  const bool outside = ((estimate.position_ned - limits_.fence_max_ned).maxCoeff() > kFenceMargin_m) ||
                       ((limits_.fence_min_ned - estimate.position_ned).maxCoeff() > kFenceMargin_m);
  if (held(low, state_.low_battery_since_ns, state_.now_ns, kLowBatteryTime_s)) {
    enter(Mode::kLanding, Reason::kBatteryLow);
    start_landing(limits_.max_speed, state_.now_ns);
  } else if (outside) {
    enter(Mode::kLanding, Reason::kOutsideFence);
    start_landing(limits_.max_speed, state_.now_ns);
  } else if (state_.mode == Mode::kSetpoint &&
             seconds(state_.now_ns - state_.setpoint_ns) > failsafe_.setpoint_timeout_s) {
    enter(Mode::kHolding, Reason::kSetpointsStopped);
    start_stop();
  }
}

void Supervisor::advance_phase(const Situation& situation) {
  const Estimate& estimate = *situation.estimate;
  if (estimate.position_ned.z() < state_.ground_z_ned - kAirborneHeight_m) state_.airborne = true;
  if (state_.phase == Phase::kSpoolUp && seconds(state_.now_ns - state_.phase_since_ns) >= kSpoolUp_s) {
    state_.phase = Phase::kPath;
    const Reference stand = state_.path.at(state_.now_ns);
    Eigen::Vector3d top = stand.position_ned;
    top.z() = state_.climb_to_z_ned;
    start_move(top, true, 0.0, state_.climb_speed, state_.now_ns);
  }
  if (state_.phase == Phase::kPath) path_ended(situation);
  if (state_.phase == Phase::kSink) {
    const bool standing =
        state_.path.at(state_.now_ns).position_ned.z() - estimate.position_ned.z() > kContactDepth_m &&
        estimate.velocity_ned.norm() < kContactSpeed;
    if (held(standing, state_.contact_since_ns, state_.now_ns, kContactTime_s)) touch_down(Reason::kLanded);
  }
}

// What comes after the path of this mode; nothing while it is still flown.
void Supervisor::path_ended(const Situation& situation) {
  if (!state_.path.finished(state_.now_ns)) return;
  switch (state_.mode) {
    case Mode::kTakingOff:
      return enter(Mode::kHolding, Reason::kTakeOffCompleted);
    case Mode::kMission: {
      const MissionItem& item = mission_->items[static_cast<std::size_t>(state_.mission.item_index)];
      if (item.kind == MissionItemKind::kLand) break;
      state_.item_end_ns = state_.path.end_ns + nanoseconds(item.hold_s);
      if (state_.now_ns < state_.item_end_ns) return;
      if (state_.mission.item_index + 1 < state_.mission.item_count) {
        ++state_.mission.item_index;
        return start_item(situation, state_.item_end_ns);
      }
      state_.mission.state = MissionState::kCompleted;
      return enter(Mode::kHolding, Reason::kMissionCompleted);
    }
    case Mode::kTrajectory:
      if (state_.next_segment < trajectory_->segments.size()) {
        return state_.path.follow(trajectory_->segments[state_.next_segment++], state_.path.end_ns);
      }
      return enter(Mode::kHolding, Reason::kTrajectoryCompleted);
    case Mode::kLanding:
      break;
    default:
      return;
  }
  // The planned part of a landing is over: sink until the ground is felt.
  state_.phase = Phase::kSink;
  state_.contact_since_ns = 0;
  const Reference end = state_.path.at(state_.now_ns);
  PolynomialSegment sink;
  sink.duration_s = 60.0;
  sink.x[0] = end.position_ned.x();
  sink.y[0] = end.position_ned.y();
  sink.z[0] = end.position_ned.z();
  sink.z[1] = kSinkSpeed;
  sink.yaw[0] = end.yaw_rad;
  state_.path.follow(sink, state_.now_ns);
}

Directive Supervisor::directive(const Situation& situation) const {
  Directive directive;
  directive.reference = flying() ? state_.path.at(state_.now_ns) : standing_at(*situation.estimate);
  switch (state_.mode) {
    case Mode::kDisarmed:
    case Mode::kStopped:
      directive.actuation = Actuation::kOff;
      return directive;
    case Mode::kArmed:
      directive.actuation = Actuation::kIdle;
      return directive;
    case Mode::kDescent:
      directive.actuation = Actuation::kLevelDescent;
      return directive;
    default:
      break;
  }
  if (state_.phase == Phase::kSpoolUp) {
    directive.actuation = Actuation::kSpoolUp;
    directive.lift_fraction =
        kSpoolUpLift * std::min(1.0, seconds(state_.now_ns - state_.phase_since_ns) / kSpoolUp_s);
  } else {
    directive.actuation = Actuation::kFly;
    directive.integrate = state_.airborne && state_.phase == Phase::kPath;
  }
  return directive;
}

void Supervisor::adopt(const SupervisorState& state, const Mission* mission, const Trajectory* trajectory) {
  state_ = state;
  mission_ = nullptr;
  trajectory_ = nullptr;
  bool plan_known = true;
  if (state_.mode == Mode::kMission) {
    const auto count = static_cast<std::size_t>(state_.mission.item_count);
    plan_known = mission != nullptr && mission->id == state_.mission.id && mission->items.size() == count;
    if (plan_known) mission_ = mission;
  } else if (state_.mode == Mode::kTrajectory) {
    plan_known = trajectory != nullptr && trajectory->id == state_.trajectory_id &&
                 state_.next_segment <= trajectory->segments.size();
    if (plan_known) trajectory_ = trajectory;
  }
  if (plan_known) return;
  enter(Mode::kHolding, Reason::kPlanUnknown);
  start_stop();
}

void Supervisor::find_flying(const Situation& situation) {
  state_.now_ns = situation.stamp_ns;
  enter(Mode::kHolding, Reason::kFoundFlying);
  state_.ground_z_ned = 0.0;
  state_.airborne = true;
  stop_from(*situation.estimate);
}

Outcome Supervisor::request(const Request& request, const Situation& situation) {
  switch (request.kind) {
    case RequestKind::kArm:
      return request_arm(situation);
    case RequestKind::kDisarm:
      if (flying()) return refuse("cannot disarm while %s; land first, or stop", to_string(state_.mode));
      enter(Mode::kDisarmed, Reason::kRequested);
      return accept();
    case RequestKind::kStop:
      enter(Mode::kStopped, Reason::kRequested);
      return accept();
    case RequestKind::kTakeoff:
      return request_takeoff(request, situation);
    case RequestKind::kMission:
      return request_mission(request, situation);
    case RequestKind::kTrajectory:
      return request_trajectory(request);
    case RequestKind::kGoTo:
    case RequestKind::kHold:
    case RequestKind::kLand:
      break;
    default:
      return refuse("unknown request %d", static_cast<int>(request.kind));
  }

  if (!flying() || state_.phase == Phase::kSpoolUp || state_.mode == Mode::kDescent)
    return refuse("cannot do that while %s", to_string(state_.mode));
  if (request.kind == RequestKind::kLand) {
    if (state_.mode == Mode::kLanding) return accept();
    const Outcome speed = check_speed("land", request.speed, limits_);
    if (!speed.accepted) return speed;
    enter(Mode::kLanding, Reason::kRequested);
    start_landing(request.speed, state_.now_ns);
    return accept();
  }
  if (request.kind == RequestKind::kHold) {
    enter(Mode::kHolding, Reason::kRequested);
    start_stop();
    return accept();
  }
  const Outcome position = check_position("goto", request.position_ned, limits_);
  if (!position.accepted) return position;
  const Outcome speed = check_speed("goto", request.speed, limits_);
  if (!speed.accepted) return speed;
  if (!request.yaw_free && !std::isfinite(request.yaw_rad)) return refuse("goto: yaw is not a finite number");
  enter(Mode::kHolding, Reason::kRequested);
  state_.phase = Phase::kPath;
  start_move(request.position_ned, request.yaw_free, request.yaw_rad, request.speed, state_.now_ns);
  return accept();
}

Outcome Supervisor::setpoint(const Setpoint& setpoint, const Situation& situation) {
  const bool takes_setpoints = state_.mode == Mode::kHolding || state_.mode == Mode::kSetpoint;
  if (!takes_setpoints) return refuse("setpoints are not followed while %s", to_string(state_.mode));
  const Outcome position = check_position("setpoint", setpoint.position_ned, limits_);
  if (!position.accepted) return position;
  if (!setpoint.velocity_ned.allFinite() || !setpoint.acceleration_ned.allFinite() ||
      !std::isfinite(setpoint.yaw_rad) || !std::isfinite(setpoint.yaw_rate)) {
    return refuse("setpoint: a value is not a finite number");
  }
  if (setpoint.velocity_ned.norm() > limits_.max_speed) {
    return refuse("setpoint: speed is %.2f m/s, the limit is %.2f m/s", setpoint.velocity_ned.norm(),
                  limits_.max_speed);
  }
  if (setpoint.acceleration_ned.norm() > limits_.max_acceleration) {
    return refuse("setpoint: acceleration is %.2f m/s^2, the limit is %.2f m/s^2",
                  setpoint.acceleration_ned.norm(), limits_.max_acceleration);
  }
  constexpr double kMaxStep_m = 1.0;
  const double step = (setpoint.position_ned - situation.estimate->position_ned).norm();
  if (step > kMaxStep_m)
    return refuse("setpoint: %.2f m away from the vehicle, the limit is %.2f m", step, kMaxStep_m);
  if (state_.mode != Mode::kSetpoint) enter(Mode::kSetpoint, Reason::kSetpointsCame);
  Reference reference;
  reference.position_ned = setpoint.position_ned;
  reference.velocity_ned = setpoint.velocity_ned;
  reference.acceleration_ned = setpoint.acceleration_ned;
  reference.yaw_rad = setpoint.yaw_rad;
  reference.yaw_rate = setpoint.yaw_rate;
  state_.path.pin(reference);
  state_.setpoint_ns = state_.now_ns;
  return accept();
}

Outcome Supervisor::request_arm(const Situation& situation) {
  if (state_.mode == Mode::kArmed) return accept();
  if (state_.mode != Mode::kDisarmed) return refuse("cannot arm while %s", to_string(state_.mode));
  const Estimate& estimate = *situation.estimate;
  if (!situation.has_estimate) return refuse("cannot arm: no mocap pose has come");
  if (situation.pose_age_s > failsafe_.mocap_timeout_s) {
    return refuse("cannot arm: the last mocap pose is %.2f s old, the limit is %.2f s", situation.pose_age_s,
                  failsafe_.mocap_timeout_s);
  }
  if (!situation.imu_healthy) return refuse("cannot arm: IMU samples are not usable");
  if (!situation.has_battery) return refuse("cannot arm: no battery voltage has come");
  if (situation.supply_voltage_v < failsafe_.low_battery_voltage) {
    return refuse("cannot arm: the battery has %.2f V, the limit is %.2f V", situation.supply_voltage_v,
                  failsafe_.low_battery_voltage);
  }
  const double tilt = std::acos(std::clamp(cosine_of_tilt(estimate.q_ned_from_frd), -1.0, 1.0));
  if (tilt > kArmTilt_rad)
    return refuse("cannot arm: tilted by %.2f rad, the limit is %.2f rad", tilt, kArmTilt_rad);
  const double speed = estimate.velocity_ned.norm();
  if (speed > kArmSpeed)
    return refuse("cannot arm: moving at %.2f m/s, the limit is %.2f m/s", speed, kArmSpeed);
  const Outcome position = check_position("cannot arm", estimate.position_ned, limits_);
  if (!position.accepted) return position;
  state_.ground_z_ned = estimate.position_ned.z();
  enter(Mode::kArmed, Reason::kRequested);
  return accept();
}

Outcome Supervisor::request_takeoff(const Request& request, const Situation& situation) {
  if (state_.mode != Mode::kArmed)
    return refuse("cannot take off while %s; arm first", to_string(state_.mode));
  const Outcome speed = check_speed("takeoff", request.speed, limits_);
  if (!speed.accepted) return speed;
  Eigen::Vector3d top = situation.estimate->position_ned;
  top.z() = request.position_ned.z();
  const Outcome position = check_position("takeoff", top, limits_);
  if (!position.accepted) return position;
  if (top.z() > state_.ground_z_ned - 2.0 * kAirborneHeight_m) {
    return refuse("takeoff: z is %.3f m, must be above the ground at %.3f m (z points down)", top.z(),
                  state_.ground_z_ned);
  }
  enter(Mode::kTakingOff, Reason::kRequested);
  start_takeoff(top.z(), request.speed, situation);
  return accept();
}

Outcome Supervisor::request_mission(const Request& request, const Situation& situation) {
  const Mission* mission = request.mission;
  if (mission == nullptr || mission->items.empty()) return refuse("the mission has no items");
  const MissionItem& first = mission->items.front();
  const bool on_ground = state_.mode == Mode::kArmed;
  if (!on_ground && state_.mode != Mode::kHolding)
    return refuse("cannot start a mission while %s", to_string(state_.mode));
  if (on_ground && first.kind != MissionItemKind::kTakeoff) {
    return refuse("the vehicle stands on the ground: the mission must begin with a takeoff");
  }
  if (on_ground && first.position_ned.z() > state_.ground_z_ned - 2.0 * kAirborneHeight_m) {
    return refuse("item 1: takeoff to z = %.3f m, must be above the ground at %.3f m (z points down)",
                  first.position_ned.z(), state_.ground_z_ned);
  }
  enter(Mode::kMission, Reason::kRequested);
  mission_ = mission;
  state_.mission = {mission->id, MissionState::kRunning, 0, static_cast<int>(mission->items.size())};
  start_item(situation, state_.now_ns);
  return accept();
}

Outcome Supervisor::request_trajectory(const Request& request) {
  if (request.trajectory == nullptr || request.trajectory->segments.empty())
    return refuse("the trajectory has no segments");
  if (state_.mode != Mode::kHolding)
    return refuse("cannot start a trajectory while %s", to_string(state_.mode));
  const Reference start = evaluate(request.trajectory->segments.front(), 0.0);
  const Outcome position = check_position("trajectory", start.position_ned, limits_);
  if (!position.accepted) return position;
  enter(Mode::kTrajectory, Reason::kRequested);
  trajectory_ = request.trajectory;
  state_.trajectory_id = trajectory_->id;
  state_.next_segment = 0;
  start_move(start.position_ned, false, start.yaw_rad, std::min(0.5, limits_.max_speed), state_.now_ns);
  return accept();
}

void Supervisor::start_takeoff(double height_ned_z, double speed, const Situation& situation) {
  state_.phase = Phase::kSpoolUp;
  state_.phase_since_ns = state_.now_ns;
  state_.climb_to_z_ned = height_ned_z;
  state_.climb_speed = speed;
  state_.path.rest(standing_at(*situation.estimate));
}

// From the reference as it is at start_ns, straight to a place; a vehicle in motion gets there by a quintic.
void Supervisor::start_move(const Eigen::Vector3d& to_ned, bool yaw_free, double yaw, double speed,
                            std::int64_t start_ns) {
  const Reference from = state_.path.at(start_ns);
  const double to_yaw = yaw_free ? from.yaw_rad : nearest_turn(yaw, from.yaw_rad);
  const double distance = (to_ned - from.position_ned).norm();
  double duration = minimum_jerk_duration(distance, speed, limits_.max_reference_acceleration, kMinMove_s);
  duration = std::max(duration, 15.0 / 8.0 * std::abs(to_yaw - from.yaw_rad) / limits_.max_yaw_rate);
  duration = std::max(duration, stopping_time(from));
  state_.path.follow(join_to_rest(from, to_ned, to_yaw, duration), start_ns);
}

// The reference of before is not known, or has been left behind.
void Supervisor::stop_from(const Estimate& estimate) {
  Reference here = standing_at(estimate);
  here.velocity_ned = estimate.velocity_ned;
  state_.path.pin(here);
  start_stop();
}

// Comes to rest along the present velocity, inside the fence.
void Supervisor::start_stop() {
  const Reference from = state_.path.at(state_.now_ns);
  const double duration = stopping_time(from);
  state_.phase = Phase::kPath;
  state_.path.follow(join_to_rest(from, stopping_place(from), from.yaw_rad, duration), state_.now_ns);
}

void Supervisor::start_landing(double speed, std::int64_t start_ns) {
  state_.phase = Phase::kPath;
  const Reference from = state_.path.at(start_ns);
  Eigen::Vector3d above_ground = stopping_place(from);
  above_ground.z() = state_.ground_z_ned - kFlareHeight_m;
  start_move(above_ground, true, 0.0, std::min(speed, failsafe_.descent_speed), start_ns);
}

double Supervisor::stopping_time(const Reference& from) const {
  return std::max(kMinMove_s, 2.0 * from.velocity_ned.norm() / limits_.max_reference_acceleration);
}

Eigen::Vector3d Supervisor::stopping_place(const Reference& from) const {
  const Eigen::Vector3d place = from.position_ned + 0.5 * stopping_time(from) * from.velocity_ned;
  return place.cwiseMax(limits_.fence_min_ned).cwiseMin(limits_.fence_max_ned);
}

void Supervisor::start_item(const Situation& situation, std::int64_t start_ns) {
  const MissionItem& item = mission_->items[static_cast<std::size_t>(state_.mission.item_index)];
  switch (item.kind) {
    case MissionItemKind::kTakeoff:
      if (state_.phase == Phase::kGround) return start_takeoff(item.position_ned.z(), item.speed, situation);
      {
        Eigen::Vector3d up = state_.path.at(start_ns).position_ned;
        up.z() = item.position_ned.z();
        return start_move(up, true, 0.0, item.speed, start_ns);
      }
    case MissionItemKind::kWaypoint:
      return start_move(item.position_ned, item.yaw_free, item.yaw_rad, item.speed, start_ns);
    case MissionItemKind::kLand:
      return start_landing(item.speed, start_ns);
  }
}

void Supervisor::touch_down(Reason reason) {
  if (state_.mode == Mode::kMission) state_.mission.state = MissionState::kCompleted;
  enter(Mode::kDisarmed, reason);
}

}  // namespace swiftlet::control

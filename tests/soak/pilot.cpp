#include "tests/soak/pilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::soak {
namespace {

using control::Mission;
using control::MissionItem;
using control::MissionItemKind;
using control::Mode;
using control::Request;
using control::RequestKind;
using control::Trajectory;
using Eigen::Vector3d;

constexpr double kMargin_m = 1.0;
constexpr double kLowest_m = 0.3;  // height
constexpr double kHighest_m = 1.7;
constexpr std::int64_t kSetpointPeriodNs = 50'000'000;
constexpr std::int64_t kFirstRequestNs = 1'000'000'000;  // once the estimator has settled

}  // namespace

Pilot::Pilot(std::uint64_t seed, const control::Limits& limits, Log log)
    : limits_(limits),
      log_(std::move(log)),
      random_(seed, plant::streams::of_name("soak.pilot")),
      next_ns_(kFirstRequestNs) {}

void Pilot::act(simulation::ClosedLoop& loop) {
  now_ns_ = loop.plant.stamp_ns();
  if (now_ns_ < setpoints_until_ns_ && now_ns_ >= next_setpoint_ns_) send_setpoint(loop);
  if (now_ns_ < next_ns_) return;
  wait(0.5);
  switch (loop.controller.status().mode) {
    case Mode::kStopped: {
      Request disarm;
      disarm.kind = RequestKind::kDisarm;
      ask(loop, disarm, "disarm");
      return;
    }
    case Mode::kDisarmed:
      return arm(loop);
    case Mode::kArmed:
      return take_off(loop);
    case Mode::kHolding:
      return start_random_action(loop);
    case Mode::kMission:
    case Mode::kTrajectory:
    case Mode::kSetpoint:
      if (random_.uniform() < 0.02) land(loop);
      return;
    case Mode::kTakingOff:
    case Mode::kLanding:
    case Mode::kDescent:
      return;
  }
}

bool Pilot::ask(simulation::ClosedLoop& loop, const Request& request, const std::string& what) {
  const control::Outcome outcome = loop.controller.request(request);
  if (log_) log_("asks: " + what + (outcome.accepted ? "" : std::string("; refused: ") + outcome.reason));
  return outcome.accepted;
}

void Pilot::arm(simulation::ClosedLoop& loop) {
  Request request;
  request.kind = RequestKind::kArm;
  ask(loop, request, "arm");
}

void Pilot::take_off(simulation::ClosedLoop& loop) {
  ++take_offs_;
  if (random_.uniform() < 0.5) return fly_mission(loop, true);
  Request request;
  request.kind = RequestKind::kTakeoff;
  request.position_ned = sample_position();
  request.speed = random_.uniform(0.3, 1.0);
  ask(loop, request, "take off");
}

void Pilot::start_random_action(simulation::ClosedLoop& loop) {
  const double what = random_.uniform();
  wait(random_.uniform(0.5, 5.0));
  if (what < 0.45) return go_to(loop);
  if (what < 0.60) return fly_mission(loop, false);
  if (what < 0.75) return fly_trajectory(loop);
  if (what < 0.90) return begin_setpoints(loop);
  if (what < 0.95) return land(loop);
  Request request;
  request.kind = RequestKind::kHold;
  ask(loop, request, "hold");
}

Vector3d Pilot::sample_position() {
  const auto along = [this](int axis) {
    return random_.uniform(limits_.fence_min_ned[axis] + kMargin_m, limits_.fence_max_ned[axis] - kMargin_m);
  };
  const double x = along(0);
  const double y = along(1);
  return {x, y, -random_.uniform(kLowest_m, kHighest_m)};
}

void Pilot::go_to(simulation::ClosedLoop& loop) {
  Request request;
  request.kind = RequestKind::kGoTo;
  request.position_ned = sample_position();
  request.speed = speed();
  request.yaw_free = random_.uniform() < 0.5;
  request.yaw_rad = random_.uniform(-M_PI, M_PI);
  ask(loop, request, "go to");
}

void Pilot::fly_mission(simulation::ClosedLoop& loop, bool from_ground) {
  Mission& mission = missions_.emplace_back();
  mission.id = missions_.size();
  const auto add = [&](MissionItemKind kind) {
    MissionItem item;
    item.kind = kind;
    item.position_ned = sample_position();
    item.yaw_free = random_.uniform() < 0.5;
    item.yaw_rad = random_.uniform(-M_PI, M_PI);
    item.speed = speed();
    item.hold_s = kind == MissionItemKind::kLand ? 0.0 : random_.uniform(0.0, 1.0);
    mission.items.push_back(item);
  };
  if (from_ground) add(MissionItemKind::kTakeoff);
  const int waypoints = 2 + static_cast<int>(random_.uniform() * 5.0);
  for (int i = 0; i < waypoints; ++i) add(MissionItemKind::kWaypoint);
  if (random_.uniform() < 0.3) add(MissionItemKind::kLand);
  const control::Outcome checked = control::check(mission, limits_);
  if (!checked.accepted) {
    if (log_) log_(std::string("mission not sent: ") + checked.reason);
    return;
  }
  Request request;
  request.kind = RequestKind::kMissionUpload;
  request.mission = &mission;
  ask(loop, request, "mission of " + std::to_string(mission.items.size()) + " items");
  request.kind = RequestKind::kMissionStart;
  request.mission_id = mission.id;
  ask(loop, request, "mission start");
}

void Pilot::fly_trajectory(simulation::ClosedLoop& loop) {
  Trajectory& trajectory = trajectories_.emplace_back();
  trajectory.id = trajectories_.size();
  Vector3d from = sample_position();
  const double yaw = loop.controller.reference().yaw_rad;
  const int segments = 2 + static_cast<int>(random_.uniform() * 3.0);
  for (int i = 0; i < segments; ++i) {
    const Vector3d to = sample_position();
    const double duration = control::minimum_jerk_duration(
        (to - from).norm(), speed(), limits_.max_reference_acceleration, limits_.max_reference_jerk);
    trajectory.segments.push_back(control::minimum_jerk(from, yaw, to, yaw, duration));
    from = to;
  }
  const control::Outcome checked = control::check(trajectory, limits_);
  if (!checked.accepted) {
    if (log_) log_(std::string("trajectory not sent: ") + checked.reason);
    return;
  }
  Request request;
  request.kind = RequestKind::kTrajectory;
  request.trajectory = &trajectory;
  ask(loop, request, "trajectory");
}

// Setpoints at constant velocity from the current reference towards a position inside the margins. Some
// continue out of the fence and are refused there.
void Pilot::begin_setpoints(simulation::ClosedLoop& loop) {
  setpoints_until_ns_ = now_ns_ + static_cast<std::int64_t>(random_.uniform(0.5, 3.0) * 1e9);
  next_setpoint_ns_ = now_ns_;
  setpoint_.position_ned = loop.controller.reference().position_ned;
  setpoint_.yaw_rad = loop.controller.reference().yaw_rad;
  const Vector3d offset = sample_position() - setpoint_.position_ned;
  setpoint_.velocity_ned = random_.uniform(0.1, 0.6) * offset.normalized();
  if (log_) log_("sends setpoints");
}

void Pilot::send_setpoint(simulation::ClosedLoop& loop) {
  next_setpoint_ns_ += kSetpointPeriodNs;
  setpoint_.stamp_ns = now_ns_;
  ++setpoint_.sequence;
  const control::Outcome outcome = loop.controller.on_setpoint(setpoint_);
  if (!outcome.accepted) {
    setpoints_until_ns_ = 0;
    if (log_) log_(std::string("setpoint refused: ") + outcome.reason);
  }
  setpoint_.position_ned += static_cast<double>(kSetpointPeriodNs) * 1e-9 * setpoint_.velocity_ned;
}

void Pilot::land(simulation::ClosedLoop& loop) {
  Request request;
  request.kind = RequestKind::kLand;
  request.speed = random_.uniform(0.2, 0.5);
  ask(loop, request, "land");
}

}  // namespace swiftlet::soak

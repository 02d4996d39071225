// A flight that the tests of the transition table bring to a state of the state machine.
#pragma once

#include "tests/unit/control/supervision/supervised_flight.hpp"

namespace swiftlet::control {

using Eigen::Vector3d;
using tests::SupervisedFlight;

constexpr GroundLinkAction kLand = GroundLinkAction::kLand;

inline SupervisionSettings settings_of(GroundLinkAction action) {
  SupervisionSettings settings;
  settings.failsafe.battery_delay_s = 0.0;
  settings.failsafe.ground_link_action = action;
  return settings;
}

inline Mission hop() {
  Mission mission;
  mission.id = 3;
  mission.items = {{MissionItemKind::kTakeoff, {0, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kWaypoint, {2, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kLand, {0, 0, 0}, 0, true, 0.4, 0.0}};
  return mission;
}

inline Mission to_two_places() {
  Mission mission;
  mission.id = 4;
  mission.items = {{MissionItemKind::kWaypoint, {1, 0, -1}, 0, true, 0.5, 0.0},
                   {MissionItemKind::kWaypoint, {1, 0.5, -1}, 0, true, 0.5, 0.0}};
  return mission;
}

inline Trajectory line() {
  Trajectory trajectory;
  trajectory.id = 5;
  trajectory.segments = {minimum_jerk({0, 0, -1}, 0.0, {1, 0, -1}, 0.0, 4.0)};
  return trajectory;
}

class Placed : public SupervisedFlight {
 public:
  explicit Placed(GroundLinkAction action) : SupervisedFlight(settings_of(action)) {}

  struct Snapshot {
    SupervisorState state;
    SupervisorInputs inputs;
    Estimate estimate;
  };
  Snapshot snapshot() const { return {supervisor_.state(), inputs_, estimate_}; }
  void restore(const Snapshot& snapshot) {
    inputs_ = snapshot.inputs;
    estimate_ = snapshot.estimate;
    supervisor_.adopt(snapshot.state, plan(), &trajectory_);
  }

  Mode mode() const { return supervisor_.mode(); }
  void lose_ground_link() {
    SupervisorState state = supervisor_.state();
    state.ground_links[1] = {7, state.now_ns - 2'000'000'000};
    supervisor_.adopt(state, plan(), &trajectory_);
  }
  void forget_plan() {
    const SupervisorState state = supervisor_.state();
    supervisor_.adopt(state, nullptr, nullptr);
  }
  const Mission* plan() const { return supervisor_.mission().id == mission_.id ? &mission_ : &two_places_; }
  Outcome stream(const Vector3d& position_ned) {
    Setpoint setpoint;
    setpoint.position_ned = position_ned;
    return supervisor_.setpoint(setpoint, inputs_);
  }

  Outcome tilt() {
    Setpoint setpoint;
    setpoint.kind = SetpointKind::kAttitude;
    setpoint.specific_thrust = plant::kGravity;
    return supervisor_.setpoint(setpoint, inputs_);
  }

  const Mission mission_ = hop();
  const Mission two_places_ = to_two_places();
  const Trajectory trajectory_ = line();
};

}  // namespace swiftlet::control

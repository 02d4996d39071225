// A supervisor whose vehicle follows the reference exactly, but never below the ground.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>

#include "swiftlet/control/supervision/supervisor.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::tests {

class SupervisedFlight {
 public:
  static constexpr std::int64_t kStep_ns = 2'000'000;

  explicit SupervisedFlight(const control::SupervisionSettings& settings = {}) : supervisor_(settings) {
    inputs_.stamp_ns = kStep_ns;
    inputs_.estimate = &estimate_;
    inputs_.has_estimate = true;
    inputs_.has_battery = true;
    inputs_.supply_voltage_v = 3.9;
    inputs_.specific_force_frd.z() = -plant::kGravity;
    step();
  }
  SupervisedFlight(const SupervisedFlight&) = delete;
  SupervisedFlight& operator=(const SupervisedFlight&) = delete;

  void step() {
    control::ClientInputs none;
    step(none);
  }
  void step(control::ClientInputs& clients) {
    inputs_.stamp_ns += kStep_ns;
    estimate_.stamp_ns = inputs_.stamp_ns;
    control_setpoint_ = supervisor_.step(inputs_, clients);
    if (control_setpoint_.control_mode == control::ControlMode::kFly && follows_) {
      estimate_.position_ned = control_setpoint_.reference.position_ned;
      estimate_.velocity_ned = control_setpoint_.reference.velocity_ned;
      if (estimate_.position_ned.z() > 0.0) {
        estimate_.position_ned.z() = 0.0;
        estimate_.velocity_ned.setZero();
      }
    }
  }
  // Steps until the predicate holds; false if it does not within `limit_s` of flight.
  bool step_until(const std::function<bool()>& predicate, double limit_s) {
    const std::int64_t end_ns = inputs_.stamp_ns + std::llround(limit_s * 1e9);
    while (inputs_.stamp_ns < end_ns) {
      if (predicate()) return true;
      step();
    }
    return predicate();
  }
  bool step_until(control::Mode mode, double limit_s) {
    return step_until([&] { return supervisor_.mode() == mode; }, limit_s);
  }

  control::Outcome ask(control::RequestKind kind, const Eigen::Vector3d& position = Eigen::Vector3d::Zero(),
                       double speed = 0.5) {
    control::Request request = next_request(kind);
    request.position_ned = position;
    request.speed = speed;
    return supervisor_.request(request, inputs_);
  }
  // The outcome of a request that is an input of the next step.
  control::Outcome step_with(control::RequestKind kind,
                             const Eigen::Vector3d& position = Eigen::Vector3d::Zero()) {
    control::Request request = next_request(kind);
    request.position_ned = position;
    control::Outcome outcome;
    control::ClientInputs clients;
    clients.add(request, outcome);
    step(clients);
    return outcome;
  }
  control::Outcome upload(const control::Mission& mission) {
    control::Request request = next_request(control::RequestKind::kMissionUpload);
    request.mission = &mission;
    return supervisor_.request(request, inputs_);
  }
  // A request of client 1 with its next id.
  control::Request next_request(control::RequestKind kind) {
    control::Request request;
    request.key = {1, ++asked_};
    request.kind = kind;
    return request;
  }
  // Uploads and starts it.
  control::Outcome fly(const control::Mission& mission) {
    const control::Outcome uploaded = upload(mission);
    return uploaded.accepted ? ask(control::RequestKind::kMissionStart) : uploaded;
  }
  control::Outcome fly(const control::Trajectory& trajectory) {
    control::Request request = next_request(control::RequestKind::kTrajectory);
    request.trajectory = &trajectory;
    return supervisor_.request(request, inputs_);
  }
  // Arms, takes off to 1 m and holds.
  bool take_off() {
    return ask(control::RequestKind::kArm).accepted &&
           ask(control::RequestKind::kTakeoff, {0, 0, -1}).accepted &&
           step_until(control::Mode::kHolding, 10.0);
  }

  control::Supervisor supervisor_;
  control::Estimate estimate_;
  control::SupervisorInputs inputs_;
  control::ControlSetpoint control_setpoint_;
  bool follows_ = true;
  std::uint64_t asked_ = 0;  // number of requests
};

}  // namespace swiftlet::tests

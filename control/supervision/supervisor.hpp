// Which mode the vehicle is in, what it is asked to do there, and when it must leave it. Requests and
// failsafes move it from mode to mode; missions, take-off and landing are flown as phases of a reference
// path.
#pragma once

#include <cstdint>

#include "control/estimation/estimator.hpp"
#include "control/mode.hpp"
#include "control/reference.hpp"
#include "control/request.hpp"
#include "control/settings.hpp"
#include "control/supervision/state.hpp"

namespace swiftlet::control {

// What the supervisor sees of a step.
struct Situation {
  std::int64_t stamp_ns = 0;
  const Estimate* estimate = nullptr;
  bool has_estimate = false;  // the estimator has been started by a pose
  double pose_age_s = 0.0;
  bool has_battery = false;  // the supply voltage is a measured one
  double supply_voltage_v = 0.0;
  double unexplained_lift = 0.0;  // m/s^2, upward specific force less what the rotors' thrust explains; about
                                  // g - thrust/m on the ground
  bool imu_healthy = true;        // this step had a sample that could be used, or one not long ago
};

enum class Actuation : std::uint8_t {
  kOff,
  kIdle,          // rotors turn at throttle 0
  kSpoolUp,       // thrust rises to lift_fraction of the weight, level
  kFly,           // position and attitude control
  kLevelDescent,  // attitude level, vertical speed by dead reckoning
};

struct Directive {
  Actuation actuation = Actuation::kOff;
  double lift_fraction = 0.0;  // kSpoolUp only
  bool integrate = false;      // the position integrals may learn
  Reference reference;
};

class Supervisor {
 public:
  Supervisor(const Limits& limits, const FailsafeSettings& failsafe);

  Directive step(const Situation& situation);
  Outcome request(const Request& request, const Situation& situation);
  // Refused setpoints (outside the fence, too fast, not flying) change nothing.
  Outcome setpoint(const Setpoint& setpoint, const Situation& situation);

  Mode mode() const { return state_.mode; }
  Reason reason() const { return state_.reason; }
  const MissionProgress& mission() const { return state_.mission; }
  bool airborne() const { return state_.airborne; }

  const SupervisorState& state() const { return state_; }
  // Goes on from the state of another controller with the same settings. mission, trajectory: what is being
  // flown there, or null where it is not known here, upon which the vehicle comes to rest and holds; owned by
  // the caller and kept until the controller has left it.
  void adopt(const SupervisorState& state, const Mission* mission, const Trajectory* trajectory);
  // The vehicle flies, and nobody knows what for: it comes to rest and holds. The ground is taken to be at z = 0.
  // Needs an estimate.
  void find_flying(const Situation& situation);

 private:
  void enter(Mode mode, Reason reason);
  bool flying() const { return state_.phase != Phase::kGround; }
  void check_failsafes(const Situation& situation);
  void advance_phase(const Situation& situation);
  void path_ended(const Situation& situation);
  Directive directive(const Situation& situation) const;

  Outcome request_arm(const Situation& situation);
  Outcome request_takeoff(const Request& request, const Situation& situation);
  Outcome request_mission(const Request& request, const Situation& situation);
  Outcome request_trajectory(const Request& request);

  void start_takeoff(double height_ned_z, double speed, const Situation& situation);
  void start_move(const Eigen::Vector3d& to_ned, bool yaw_free, double yaw, double speed,
                  std::int64_t start_ns);
  void start_stop();
  void stop_from(const Estimate& estimate);
  double stopping_time(const Reference& from) const;
  Eigen::Vector3d stopping_place(const Reference& from) const;
  void start_landing(double speed, std::int64_t start_ns);
  void start_item(const Situation& situation, std::int64_t start_ns);
  void touch_down(Reason reason);

  Limits limits_;
  FailsafeSettings failsafe_;
  double tip_over_cosine_;
  SupervisorState state_;
  const Mission* mission_ = nullptr;  // what state_.mission and state_.trajectory_id are of
  const Trajectory* trajectory_ = nullptr;
};

}  // namespace swiftlet::control

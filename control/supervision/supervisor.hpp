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
#include "control/trajectory/reference_path.hpp"

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

  Mode mode() const { return mode_; }
  const char* reason() const { return reason_; }
  const MissionProgress& mission() const { return progress_; }
  bool airborne() const { return airborne_; }

 private:
  enum class Phase : std::uint8_t { kGround, kSpoolUp, kPath, kSink };

  void enter(Mode mode, const char* reason);
  bool flying() const { return phase_ != Phase::kGround; }
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
  double stopping_time(const Reference& from) const;
  Eigen::Vector3d stopping_place(const Reference& from) const;
  void start_landing(double speed, std::int64_t start_ns);
  void start_item(const Situation& situation, std::int64_t start_ns);
  void touch_down(const char* reason);

  Limits limits_;
  FailsafeSettings failsafe_;
  double tip_over_cosine_;
  Mode mode_ = Mode::kDisarmed;
  const char* reason_ = "started";
  std::int64_t mode_since_ns_ = 0;
  std::int64_t now_ns_ = 0;

  Phase phase_ = Phase::kGround;
  std::int64_t phase_since_ns_ = 0;
  ReferencePath path_;
  double climb_to_z_ = 0.0;  // of the take-off under way
  double climb_speed_ = 0.5;
  double ground_z_ = 0.0;  // where it stood when it was armed
  bool airborne_ = false;
  std::int64_t contact_since_ns_ = 0;      // 0: no contact
  std::int64_t low_battery_since_ns_ = 0;  // 0: battery is well

  const Mission* mission_ = nullptr;
  MissionProgress progress_;
  std::int64_t item_end_ns_ = 0;  // path and hold of the item being flown
  const Trajectory* trajectory_ = nullptr;
  std::size_t next_segment_ = 0;
  std::int64_t setpoint_stamp_ns_ = 0;
};

}  // namespace swiftlet::control

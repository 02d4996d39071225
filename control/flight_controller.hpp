// The whole controller as pure code: samples and requests in, actuator commands out. No clock, no I/O, no threads, no heap after
// construction; time is what the samples' stamps say. One thread calls it.
#pragma once

#include <cstdint>
#include <memory>

#include "control/estimation/estimator.hpp"
#include "control/reference.hpp"
#include "control/request.hpp"
#include "control/settings.hpp"
#include "plant/model/samples.hpp"
#include "plant/model/vehicle.hpp"

namespace swiftlet::control {

enum class Mode : std::uint8_t {
  kDisarmed = 0,   // rotors off
  kArmed = 1,      // on the ground, rotors turning slowly
  kTakingOff = 2,
  kHolding = 3,
  kMission = 4,
  kTrajectory = 5,
  kSetpoint = 6,   // follows a setpoint stream
  kLanding = 7,
  kDescent = 8,    // level, without position, until the ground or a time-out
  kStopped = 9,    // rotors off by a request or a failsafe; disarm to leave
};
const char* to_string(Mode mode);

enum class MissionState : std::uint8_t { kNone = 0, kRunning = 1, kCompleted = 2, kAborted = 3 };

struct MissionProgress {
  std::uint64_t id = 0;
  MissionState state = MissionState::kNone;
  int item_index = 0;  // the item being flown
  int item_count = 0;
};

// What the controller says of itself after each step.
struct Status {
  Mode mode = Mode::kDisarmed;
  const char* reason = "";     // why the mode was entered; a static string
  bool has_pose = false;       // a mocap pose has come within the time-out
  double pose_age_s = 0.0;     // at this step
  bool airborne = false;
  double supply_voltage_v = 0.0;
  bool saturated = false;      // the last command was cut by the rotors' limits
  MissionProgress mission;
};

// What each step asked of the inner loop, for plots and logs.
struct AttitudeSetpoint {
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  double thrust_n = 0.0;
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m
};

class FlightController {
 public:
  // Designs all gains. Throws std::invalid_argument with a sentence if the vehicle or the settings break a rule.
  FlightController(const plant::Vehicle& vehicle, const ControlSettings& settings);
  ~FlightController();
  FlightController(FlightController&&) noexcept;
  FlightController& operator=(FlightController&&) noexcept;

  // One step of the inner loop: the command that answers this sample. A sample that is not finite or not newer than
  // the last one is not used; the command then repeats the last.
  plant::ActuatorCommand on_imu(const plant::ImuSample& sample);

  void on_pose(const plant::PoseSample& sample);
  void on_battery(const plant::BatterySample& sample);
  void on_rotor_speeds(const plant::RotorSpeedSample& sample);
  void on_setpoint(const Setpoint& setpoint);
  Outcome request(const Request& request);

  // As of the last step.
  const Estimate& estimate() const;
  const Reference& reference() const;
  const AttitudeSetpoint& attitude_setpoint() const;
  const Status& status() const;

 private:
  struct Loops;
  std::unique_ptr<Loops> loops_;
};

}  // namespace swiftlet::control

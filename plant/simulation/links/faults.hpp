// Faults that a simulation injects: kind, start and duration. The schedule is part of the simulation
// settings. It depends on stamps only and does not change any random draw. A flight with faults is therefore
// reproducible, and until the first fault it equals the flight without faults.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::plant {

enum class FaultKind : std::uint8_t {
  // Motion capture. The stamp at which a frame would be delivered decides.
  kMocapStop,       // no frames
  kMocapFreeze,     // frames repeat the last pose before the fault, with new stamps and sequence numbers
  kMocapUntracked,  // frames without a pose
  kMocapJump,       // poses with an added offset and rotation
  kMocapSwap,       // poses of another body at rest
  kMocapLatency,    // additional latency; frames still delayed when the fault ends are lost
  // Sensors of the vehicle. Samples that are not sent still count in the sequence.
  kImuStop,          // no IMU samples
  kImuNan,           // IMU samples with NaN values
  kImuStuck,         // IMU samples repeat the last values before the fault
  kImuBias,          // offset in addition to the bias of the settings
  kBatteryStop,      // no battery samples
  kRotorSpeedsStop,  // no rotor speed samples
  // Vehicle and air.
  kBatteryDrop,  // lower open-circuit voltage of the cell; affects motors and battery samples
  kRotorThrust,  // one rotor has only a fraction of its thrust and torque
  kPush,         // force and moment on the body
  kWind,         // wind in addition to that of the settings
  // Link of the actuator commands to the vehicle.
  kCommandsStop,   // commands are lost
  kCommandsDelay,  // commands are delayed
  // The vehicle's own estimate, of a vehicle that brings it.
  kOdometryJump,  // turned about the origin and moved, with a reset at the start and at the end
};
// As in the simulation file, by kind.
constexpr const char* kFaultKindNames[] = {
    "mocap_stop",    "mocap_freeze",      "mocap_untracked", "mocap_jump",   "mocap_swap",
    "mocap_latency", "imu_stop",          "imu_nan",         "imu_stuck",    "imu_bias",
    "battery_stop",  "rotor_speeds_stop", "battery_drop",    "rotor_thrust", "push",
    "wind",          "commands_stop",     "commands_delay",  "odometry_jump"};
constexpr std::size_t kFaultKinds = std::size(kFaultKindNames);
inline const char* to_string(FaultKind kind) { return kFaultKindNames[static_cast<std::size_t>(kind)]; }

// A fault is active in the half-open interval [at_s, at_s + for_s). Only the parameters of its kind are used.
struct Fault {
  FaultKind kind = FaultKind::kMocapStop;
  double at_s = 0.0;   // start, simulated time since the plant's start
  double for_s = 0.0;  // duration, at least one integration step

  Eigen::Vector3d position_ned =
      Eigen::Vector3d::Zero();  // m, kMocapJump, kOdometryJump: offset; kMocapSwap: position
  Eigen::Vector3d rotation_frd = Eigen::Vector3d::Zero();  // rad, kMocapJump: rotation vector, in body axes
  double yaw_rad = 0.0;  // kMocapSwap: yaw of the other body, which is level; kOdometryJump: turn
  double delay_s = 0.0;  // kMocapLatency, kCommandsDelay
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2, kImuBias
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s, kImuBias
  double voltage_v = 0.0;                                        // kBatteryDrop: voltage drop
  int rotor = 1;                                        // kRotorThrust: index from 1, as in the vehicle file
  double factor = 1.0;                                  // kRotorThrust: fraction of thrust and torque, 0 .. 1
  Eigen::Vector3d force_ned = Eigen::Vector3d::Zero();  // N, kPush, at the centre of mass
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m, kPush
  Eigen::Vector3d wind_ned = Eigen::Vector3d::Zero();    // m/s, kWind
};

// Adds every rule that the faults violate to `check`, with keys as in the simulation file
// ("faults[2].for_s").
void check_faults(const std::vector<Fault>& faults, double step_s, RuleChecker& check);
// Returns every violated rule that depends on the vehicle.
std::vector<Violation> validate_faults(const std::vector<Fault>& faults, const Vehicle& vehicle);

// The faults by kind and time. At most one fault of each kind is active at a time.
class FaultSchedule {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  FaultSchedule() = default;
  // Precondition: check_faults() finds no violation.
  explicit FaultSchedule(const std::vector<Fault>& faults);

  // The fault of this kind that is active at a stamp; null if there is none.
  const Fault* active(FaultKind kind, std::int64_t stamp_ns) const;
  // The first stamp after this one at which a fault starts or ends; kNever if there is none.
  std::int64_t next_change_ns(std::int64_t stamp_ns) const;
  bool empty() const { return changes_ns_.empty(); }
  bool has(FaultKind kind) const { return !of(kind).empty(); }
  double longest_delay_s(FaultKind kind) const;

 private:
  struct Entry {
    std::int64_t from_ns;
    std::int64_t to_ns;  // exclusive
    Fault fault;
  };

  const std::vector<Entry>& of(FaultKind kind) const { return by_kind_[static_cast<std::size_t>(kind)]; }

  std::array<std::vector<Entry>, kFaultKinds> by_kind_;  // each sorted by time
  std::vector<std::int64_t> changes_ns_;                 // ascending
};

}  // namespace swiftlet::plant

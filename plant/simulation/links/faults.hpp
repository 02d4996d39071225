// Faults that a simulation injects: what goes wrong, when, for how long. A schedule is part of the simulation
// settings, goes by the stamps alone, and leaves every random draw as it is without faults: a flight with
// faults repeats as any other, and up to the first fault it is the flight without them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/violation.hpp"

namespace swiftlet::plant {

enum class FaultKind : std::uint8_t {
  // Motion capture, by the stamp at which a frame would be delivered.
  kMocapStop,       // no frames
  kMocapFreeze,     // the pose of the last frame before again and again, with new stamps and numbers
  kMocapUntracked,  // frames without a pose
  kMocapJump,       // poses off by an offset and a turn
  kMocapSwap,       // poses of another body, which stands somewhere
  kMocapLatency,    // frames come later than they do anyway; what they are overtaken by at the end is lost
  // The vehicle's sensors. Samples that are not sent keep their numbers.
  kImuStop,
  kImuNan,    // samples that are not numbers
  kImuStuck,  // the values of the last sample before again and again
  kImuBias,   // an offset beside the settings' bias
  kBatteryStop,
  kRotorSpeedsStop,
  // The vehicle and the air.
  kBatteryDrop,  // the cell's open-circuit voltage is lower; motors and battery samples feel it
  kRotorThrust,  // a rotor gives only a part of its thrust and torque
  kPush,         // a force and a moment on the body
  kWind,         // beside the settings' wind
  // The actuator commands on their way to the vehicle.
  kCommandsStop,   // they are lost
  kCommandsDelay,  // they come later
};
constexpr std::size_t kFaultKinds = static_cast<std::size_t>(FaultKind::kCommandsDelay) + 1;
const char* to_string(FaultKind kind);  // as in the simulation file: "mocap_stop"

// Is there from at_s up to at_s + for_s, that end not included. Of the parameters, those of the kind count.
struct Fault {
  FaultKind kind = FaultKind::kMocapStop;
  double at_s = 0.0;   // from the plant's start, simulated time
  double for_s = 0.0;  // at least an integration step

  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m, kMocapJump: the offset; kMocapSwap: the place
  Eigen::Vector3d rotation_frd = Eigen::Vector3d::Zero();  // rad, kMocapJump: rotation vector, in body axes
  double yaw_rad = 0.0;                                    // kMocapSwap: of that body, which is level
  double delay_s = 0.0;                                    // kMocapLatency, kCommandsDelay
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2, kImuBias
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s, kImuBias
  double voltage_v = 0.0;                                        // kBatteryDrop: by so much
  int rotor = 1;                                         // kRotorThrust: from 1, as in the vehicle file
  double factor = 1.0;                                   // kRotorThrust: 0 .. 1
  Eigen::Vector3d force_ned = Eigen::Vector3d::Zero();   // N, kPush, at the centre of mass
  Eigen::Vector3d moment_frd = Eigen::Vector3d::Zero();  // N m, kPush
  Eigen::Vector3d wind_ned = Eigen::Vector3d::Zero();    // m/s, kWind
};

// Every rule that the faults break, with keys as in the simulation file ("faults[2].for_s").
void check_faults(const std::vector<Fault>& faults, double step_s, RuleChecker& check);
// The same for what depends on the vehicle that flies.
std::vector<Violation> validate_faults(const std::vector<Fault>& faults, const Vehicle& vehicle);

// The faults by kind and time. Of a kind at most one is there at a time.
class FaultSchedule {
 public:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();

  FaultSchedule() = default;
  // check_faults() finds nothing against them.
  explicit FaultSchedule(const std::vector<Fault>& faults);

  // The fault of this kind that is there at a stamp; null if there is none.
  const Fault* active(FaultKind kind, std::int64_t stamp_ns) const;
  // The first stamp after this one at which a fault comes or goes; kNever if none does any more.
  std::int64_t next_change_ns(std::int64_t stamp_ns) const;
  bool empty() const { return changes_ns_.empty(); }
  bool has(FaultKind kind) const { return !of(kind).empty(); }
  double longest_delay_s(FaultKind kind) const;

 private:
  struct Entry {
    std::int64_t from_ns;
    std::int64_t to_ns;  // not included
    Fault fault;
  };

  const std::vector<Entry>& of(FaultKind kind) const { return by_kind_[static_cast<std::size_t>(kind)]; }

  std::array<std::vector<Entry>, kFaultKinds> by_kind_;  // each in the order of time
  std::vector<std::int64_t> changes_ns_;                 // rising
};

}  // namespace swiftlet::plant

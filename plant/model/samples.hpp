// Inputs and outputs of the vehicle and of motion capture as plain structs. Frames: n is North-East-Down
// (suffix _ned), b is Forward-Right-Down (suffix _frd). SI units, radians. stamp_ns is the time of the
// measurement on the vehicle's clock. sequence counts up from 1 in each stream.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::plant {

constexpr int kMinRotors = 4;
constexpr int kMaxRotors = 8;

// One value per rotor. Only the first rotor_count entries are used; the rest are 0.
using PerRotor = std::array<double, kMaxRotors>;

struct ImuSample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2; (0, 0, -g) at rest and level
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s: p, q, r
};

// The vehicle's own estimate of its motion, of a vehicle that brings it in place of raw IMU samples. Its NED frame may differ
// from that of motion capture.
struct OdometrySample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  bool position_valid = false;                             // false: the position below is not known
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  bool velocity_valid = false;
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s: p, q, r, bias removed
  // Standard deviations of the errors, each axis; 0: not known.
  Eigen::Vector3d position_deviation = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_deviation = Eigen::Vector3d::Zero();  // m/s
  Eigen::Vector3d rotation_deviation = Eigen::Vector3d::Zero();  // rad
  std::uint32_t resets = 0;  // counts up with each jump of position, velocity or attitude that is no motion
  bool fuses_mocap = false;  // its position is that of motion capture, not of sensors of its own
};

struct PoseSample {
  std::int64_t stamp_ns = 0;  // exposure of the frame, not its arrival
  std::uint64_t sequence = 0;
  bool tracked = false;  // false: too few markers were visible, the pose below is invalid
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
};

struct BatterySample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  double voltage_v = 0.0;  // v_s of Eq. (9), at the terminals
  double current_a = 0.0;
  double state_of_charge = 0.0;  // 0 empty .. 1 full
};

struct RotorSpeedSample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  int rotor_count = 0;
  PerRotor speeds{};  // rad/s
};

// The newest samples of the sensors beside IMU and motion capture.
struct SensorSamples {
  std::optional<BatterySample> battery;
  std::optional<RotorSpeedSample> rotor_speeds;
};

// In lockstep: the sequence numbers of the newest samples that belong to an IMU sample; 0: none.
struct LockstepInputs {
  std::uint64_t mocap_pose = 0;
  std::uint64_t battery = 0;
  std::uint64_t rotor_speeds = 0;
};

// Calls use() for each sensor of SensorSamples, with its member of each of the structs.
template <class Use, class... Structs>
void for_each_sensor(const Use& use, Structs&... of) {
  use(of.rotor_speeds...);
  use(of.battery...);
}

// "Off" differs from throttle 0, at which the ESC of Eq. (9) still turns the rotor.
enum class RotorState : std::uint8_t { kOff = 0, kRunning = 1 };

// The part that the commands of all levels have in common (vehicle_command.hpp has the other levels).
struct CommandHeader {
  std::int64_t stamp_ns = 0;  // stamp of the IMU sample that this command was computed from
  std::uint64_t sequence = 0;
  std::uint64_t imu_sequence = 0;    // sequence of that IMU sample
  std::uint64_t mocap_sequence = 0;  // newest mocap frame received before this command
  RotorState rotor_state = RotorState::kOff;
  std::uint32_t term = 0;  // controller's term: a controller that takes over starts a higher one
};

struct ActuatorCommand : CommandHeader {
  int rotor_count = 0;
  PerRotor throttle{};  // delta of Eq. (8), 0 .. 1
};

// The vehicle's report of the newest command that it accepted.
struct ObeyedCommand {
  bool reported = false;  // the vehicle sends this report; if false, all fields below are invalid
  bool any = false;       // a command was accepted since start-up; if false, the fields below are invalid
  std::uint32_t term = 0;
  std::int64_t stamp_ns = 0;  // stamp of the IMU sample that the command was computed from
  std::uint32_t boot = 0;     // number of this start of the vehicle, valid without a report too; 0: not known
};

// Ground truth of the simulated vehicle. Only the motion capture simulator and recorders may read it.
struct TruthSample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  Eigen::Vector3d position_ned = Eigen::Vector3d::Zero();  // m
  Eigen::Vector3d velocity_ned = Eigen::Vector3d::Zero();  // m/s
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s
  int rotor_count = 0;
  PerRotor rotor_speeds{};  // rad/s
  double supply_voltage_v = 0.0;
  bool on_ground = false;
};

}  // namespace swiftlet::plant

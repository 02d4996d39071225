// The vehicle and mocap boundaries as plain structs: what a vehicle measures, what it obeys, what motion
// capture sees. Frames: n is North-East-Down (suffix _ned), b is Forward-Right-Down (suffix _frd). SI units,
// radians. stamp_ns is the time of the measurement on the vehicle's clock; sequence counts up from 1 for each
// stream.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace swiftlet::plant {

constexpr int kMinRotors = 4;
constexpr int kMaxRotors = 8;

// One value per rotor; only the first rotor_count entries have a meaning, the rest are zero.
using PerRotor = std::array<double, kMaxRotors>;

struct ImuSample {
  std::int64_t stamp_ns = 0;
  std::uint64_t sequence = 0;
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2; (0, 0, -g) at rest and level
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();      // rad/s: p, q, r
};

struct PoseSample {
  std::int64_t stamp_ns = 0;  // when the frame was exposed, not when it arrived
  std::uint64_t sequence = 0;
  bool tracked = false;  // false: the system saw too few markers; the pose is then without meaning
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

// "Rotors off" is a state of its own: at throttle 0 the ESC of Eq. (9) still turns them.
enum class RotorState : std::uint8_t { kOff = 0, kRunning = 1 };

struct ActuatorCommand {
  std::int64_t stamp_ns = 0;  // stamp of the IMU sample that this command answers
  std::uint64_t sequence = 0;
  std::uint64_t imu_sequence = 0;    // the IMU sample that this command answers
  std::uint64_t mocap_sequence = 0;  // the newest mocap frame that had been taken in
  RotorState rotor_state = RotorState::kOff;
  int rotor_count = 0;
  PerRotor throttle{};     // delta of Eq. (8), 0 .. 1
  std::uint32_t term = 0;  // of the controller: whoever takes over from another begins a higher one
};

// What the vehicle says of the commands that reach it.
struct ObeyedCommand {
  bool reported = false;  // it says so at all; else nothing below has a meaning
  bool any = false;       // it has obeyed a command since it was started; else the rest has no meaning
  std::uint32_t term = 0;
  std::int64_t stamp_ns = 0;  // of the IMU sample that the command answered
};

// What a perfect observer knows of the vehicle. Only the mocap simulation and recorders may look at it.
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

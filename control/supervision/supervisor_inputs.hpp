// What the supervisor sees of a step, and what it asks for.
#pragma once

#include <cstdint>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/types/reference.hpp"

namespace swiftlet::control {

struct SupervisorInputs {
  std::int64_t stamp_ns = 0;
  const Estimate* estimate = nullptr;
  bool has_estimate = false;  // the estimator has been started by a pose
  double pose_age_s = 0.0;
  bool pose_jumped = false;  // since the last step the estimate gave in to poses that disagreed for long
  bool takeoff_inconsistent =
      false;  // after the lift-off the pose does not follow the motion (estimation/takeoff_consistency.hpp)
  bool has_battery = false;  // the supply voltage is a measured one
  double supply_voltage_v = 0.0;
  double battery_age_s = 0.0;
  double vertical_specific_force_residual =
      0.0;  // m/s^2, upward specific force less what the rotors' thrust explains; about
            // g - thrust/m on the ground
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2, of the last sample
  double rotor_speed = 0.0;                                      // rad/s, of the fastest rotor
  double imu_unusable_s = 0.0;                                   // for how long no sample could be used
  double imu_gap_s = 0.0;  // between this usable sample and the one before
};

enum class ControlMode : std::uint8_t {
  kOff,
  kIdle,          // rotors turn at throttle 0
  kSpoolUp,       // thrust rises to lift_fraction of the weight, level
  kFly,           // position and attitude control
  kLevelDescent,  // attitude level, vertical speed by dead reckoning
  kAttitude,      // q_ned_from_frd, with body_rates_frd fed forward, and thrust
  kBodyRates,     // body_rates_frd and thrust
};

struct ControlSetpoint {
  ControlMode control_mode = ControlMode::kOff;
  double lift_fraction = 0.0;  // kSpoolUp only
  double descent_speed = 0.0;  // m/s; kLevelDescent only
  bool integrate = false;      // the position integrals may learn
  Reference reference;
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s
  double specific_thrust = 0.0;                                       // m/s^2, of the vehicle's mass
};

}  // namespace swiftlet::control

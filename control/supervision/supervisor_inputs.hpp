// Input and output of the supervisor in a step.
#pragma once

#include <cstdint>
#include <limits>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/reference.hpp"
#include "swiftlet/plant/model/control_level.hpp"

namespace swiftlet::control {

struct SupervisorInputs {
  std::int64_t stamp_ns = 0;
  const Estimate* estimate = nullptr;
  bool has_estimate = false;         // a pose has initialised the estimator
  double pose_age_s = 0.0;           // of the vehicle's own position, if it is flown by its own estimate
  bool brings_odometry = false;      // the vehicle, in place of IMU samples
  bool estimate_of_vehicle = false;  // it is flown by its own estimate
  bool pose_jumped = false;  // the estimate was reset to poses that disagreed for long, since the last step
  // Stamp at which the vehicle lifted off, as the accelerometer shows it; 0: not observed; or kNoLiftOffYet.
  std::int64_t lift_off_ns = 0;
  double command_delay_s =
      0.0;  // from a sample to the vehicle that obeys the command that answers it; 0: not known
  bool takeoff_inconsistent =
      false;  // after lift-off the poses do not follow the motion (estimation/takeoff_consistency.hpp)
  const char* hover_test_defect = "";  // what the hover test has found; empty: nothing
  bool has_battery = false;            // the supply voltage was measured
  double supply_voltage_v = 0.0;
  double implausible_supply_v = 0.0;  // measured instead, and not used; 0: none
  double least_supply_v = 0.0;        // of the plausible ones of this vehicle
  double most_supply_v = 0.0;
  double battery_age_s = 0.0;
  double vertical_specific_force_residual =
      0.0;  // m/s^2, upward specific force minus rotor thrust over mass; about
            // g - thrust/m on the ground
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();  // m/s^2, last sample
  double rotor_speed = 0.0;                                      // rad/s, fastest rotor
  double imu_unusable_s = 0.0;                                   // time without a usable sample
  double imu_gap_s = 0.0;                                        // s between the last two usable samples
  const ControlGains* gains = nullptr;                           // in force; null: not known
  double gains_progress = 1.0;                                   // of their change
  double gains_changing_s = 0.0;                                 // time until they stop changing
  bool vehicle_restarted = false;                                // since the last step
  // For how long the vehicle has reported that it obeys no command, or another controller's; 0: it obeys, or does not report.
  double not_obeyed_s = 0.0;
  // At which the vehicle is commanded, and which it accepts.
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  plant::ControlLevels accepted_levels = plant::ControlLevel::kActuators;
  // What vehicle_info reports as fault, and for how long; empty: none. Only above level actuators, where the
  // vehicle has loops and modes of its own.
  const char* vehicle_refusal = "";  // why it must not be armed; empty: it may
  const char* vehicle_fault = "";
  double vehicle_fault_s = 0.0;
  bool rotors_running = true;  // as the vehicle reports; true at level actuators, where rotors start at once
  // Time since the rotors' limits cut a command.
  double unsaturated_s = std::numeric_limits<double>::infinity();
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
  bool integrate = false;      // the position integrals are active
  Reference reference;
  Eigen::Quaterniond q_ned_from_frd = Eigen::Quaterniond::Identity();
  Eigen::Vector3d body_rates_frd = Eigen::Vector3d::Zero();  // rad/s
  double specific_thrust = 0.0;                              // m/s^2, thrust over mass
};

}  // namespace swiftlet::control

#include "swiftlet/control/supervision/arming.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string_view>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/supervision/conditions.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {
namespace {

using ArmingCheck = Outcome (*)(const SupervisorContext&);

Outcome pose_available(const SupervisorContext& context) {
  const SupervisorInputs& inputs = context.inputs;
  const double limit_s = context.settings.failsafe.mocap_timeout_s;
  if (inputs.estimate_of_vehicle) {
    if (inputs.has_estimate && inputs.pose_age_s <= limit_s) return accept();
    return refuse("the vehicle's own estimate, by which it is to be flown, has no position");
  }
  if (!inputs.has_estimate) return refuse("no mocap pose received");
  if (inputs.pose_age_s > limit_s)
    return refuse("the last mocap pose is %.2f s old, the limit is %.2f s", inputs.pose_age_s, limit_s);
  return accept();
}

// A late or duplicate pose is no fault of motion capture.
Outcome pose_accepted(const SupervisorContext& context) {
  const PoseFault fault = context.estimate().pose_fault;
  if (fault == PoseFault::kNone || fault == PoseFault::kUntimely) return accept();
  return refuse("the last mocap pose was refused: %s", to_string(fault));
}

Outcome imu_usable(const SupervisorContext& context) {
  if (context.inputs.imu_unusable_s > 0.0) return refuse("IMU samples are not usable");
  return accept();
}

Outcome battery_available(const SupervisorContext& context) {
  const SupervisorInputs& inputs = context.inputs;
  const FailsafeSettings& failsafe = context.settings.failsafe;
  if (inputs.implausible_supply_v != 0.0) {
    return refuse("battery voltage %.2f V is not one of this vehicle's battery, %.2f to %.2f V",
                  inputs.implausible_supply_v, inputs.least_supply_v, inputs.most_supply_v);
  }
  if (!inputs.has_battery) return refuse("no battery voltage received");
  if (inputs.battery_age_s > failsafe.battery_timeout_s) {
    return refuse("the last battery voltage is %.1f s old, the limit is %.1f s", inputs.battery_age_s,
                  failsafe.battery_timeout_s);
  }
  if (inputs.supply_voltage_v < failsafe.low_battery_voltage) {
    return refuse("battery voltage %.2f V is too low; minimum is %.2f V", inputs.supply_voltage_v,
                  failsafe.low_battery_voltage);
  }
  return accept();
}

// With a wrong attitude, the rest of the specific force beyond gravity looks like an accelerometer bias. If
// it is too large for a bias, dead reckoning diverges.
Outcome imu_at_rest(const SupervisorContext& context) {
  if (!context.inputs.has_estimate) return accept();
  const Eigen::Vector3d up_ned(0.0, 0.0, -plant::kGravity);
  const double error =
      (context.estimate().q_ned_from_frd * context.inputs.specific_force_frd - up_ned).norm();
  const double limit = context.settings.arming.max_specific_force_error;
  if (error <= limit) return accept();
  return refuse(
      "the accelerometer is %.2f m/s^2 off gravity in the attitude of the pose, the limit is %.2f m/s^2",
      error, limit);
}

Outcome not_turning(const SupervisorContext& context) {
  const double rate = context.estimate().body_rates_frd.norm();
  const double limit = context.settings.arming.max_body_rate;
  if (rate <= limit) return accept();
  return refuse("turning at %.2f rad/s, the limit is %.2f rad/s", rate, limit);
}

Outcome rotors_still(const SupervisorContext& context) {
  const double speed = context.inputs.rotor_speed;
  const double limit = context.settings.arming.max_rotor_speed;
  if (speed <= limit) return accept();
  return refuse("a rotor turns at %.0f rad/s, the limit is %.0f rad/s", speed, limit);
}

Outcome level(const SupervisorContext& context) {
  if (!context.inputs.has_estimate) return accept();
  const double tilt = std::acos(std::clamp(cosine_of_tilt(context.estimate().q_ned_from_frd), -1.0, 1.0));
  const double limit = context.settings.arming.max_tilt_rad;
  if (tilt <= limit) return accept();
  return refuse("tilted by %.2f rad, the limit is %.2f rad", tilt, limit);
}

Outcome not_moving(const SupervisorContext& context) {
  const double speed = context.estimate().velocity_ned.norm();
  const double limit = context.settings.arming.max_speed;
  if (speed <= limit) return accept();
  return refuse("moving at %.2f m/s, the limit is %.2f m/s", speed, limit);
}

// A vehicle that stands on the ground may measure a z slightly below it.
Outcome inside_fence(const SupervisorContext& context) {
  if (!context.inputs.has_estimate) return accept();
  Limits limits = context.settings.limits;
  limits.fence_max_ned.z() += context.settings.failsafe.fence_margin_m;
  return check_inside_fence("the vehicle", context.estimate().position_ned, limits);
}

Outcome level_accepted(const SupervisorContext& context) {
  const SupervisorInputs& inputs = context.inputs;
  if (inputs.accepted_levels.has(inputs.level)) return accept();
  return refuse("the vehicle does not accept commands at level %s, it accepts %s",
                plant::to_string(inputs.level), inputs.accepted_levels.names().data());
}

Outcome samples_fit_level(const SupervisorContext& context) {
  const SupervisorInputs& inputs = context.inputs;
  if (!inputs.brings_odometry || inputs.level != plant::ControlLevel::kActuators) return accept();
  return refuse("level actuators needs imu, but the vehicle brings vehicle_odometry");
}

Outcome vehicle_acceptable(const SupervisorContext& context) {
  if (context.inputs.vehicle_refusal[0] == '\0') return accept();
  return refuse("%s", context.inputs.vehicle_refusal);
}

Outcome no_vehicle_fault(const SupervisorContext& context) {
  if (context.inputs.vehicle_fault[0] == '\0') return accept();
  return refuse("the vehicle reports: %s", context.inputs.vehicle_fault);
}

constexpr ArmingCheck kChecks[] = {vehicle_acceptable, level_accepted, samples_fit_level, no_vehicle_fault,
                                   pose_available,     pose_accepted,  imu_usable,        battery_available,
                                   imu_at_rest,        not_turning,    rotors_still,      level,
                                   not_moving,         inside_fence};

// Appends "; sentence" if it fits.
void append(const char* sentence, Outcome& outcome) {
  const std::string_view joint = outcome.accepted ? "cannot arm: " : "; ";
  const std::string_view addition = sentence;
  const std::size_t used = std::strlen(outcome.reason);
  outcome.accepted = false;
  if (used + joint.size() + addition.size() >= sizeof outcome.reason) return;
  char* const end = std::copy(joint.begin(), joint.end(), outcome.reason + used);
  *std::copy(addition.begin(), addition.end(), end) = '\0';
}

}  // namespace

Outcome check_arming(const SupervisorContext& context) {
  Outcome outcome = accept();
  for (const ArmingCheck check : kChecks) {
    const Outcome one = check(context);
    if (!one.accepted) append(one.reason, outcome);
  }
  return outcome;
}

}  // namespace swiftlet::control

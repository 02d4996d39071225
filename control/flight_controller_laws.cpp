// The control laws in a step of the controller: the outer loop of each control mode, and the inner loop.
#include <cmath>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/flight_controller_impl.hpp"
#include "swiftlet/control/position/thrust_attitude_map.hpp"
#include "swiftlet/math/euler.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kDescentGain = 4.0;   // 1/s, vertical speed error to acceleration, level descent
constexpr double kBrakeGain = 2.0;     // 1/s, the same for the horizontal speed
constexpr double kDescentLimit = 2.0;  // m/s^2, of that acceleration
// The law kLead leads by this share of the attitude loop's lag. A longer lead helps little more in gusts, and passes
// on more noise.
constexpr double kLeadShare = 2.0 / 3.0;

}  // namespace

AttitudeDemand FlightController::Impl::outer_loop(const ControlSetpoint& setpoint, double dt_s) {
  switch (setpoint.control_mode) {
    case ControlMode::kSpoolUp:
      return spool_up(setpoint.lift_fraction, dt_s);
    case ControlMode::kLevelDescent:
      return descend_level(setpoint.descent_speed);
    case ControlMode::kAttitude:
    case ControlMode::kBodyRates:
      return follow_direct_setpoint(setpoint);
    default:
      return follow_reference(setpoint.integrate, dt_s);
  }
}

double FlightController::Impl::ground_effect_now() const {
  const RoughAirSettings& of = settings.rough_air;
  if (!(of.rotor_radius_m > 0.0)) return 1.0;
  const double above_m = supervisor.state().guidance.ground_z_ned - estimate().position_ned.z();
  return plant::ground_effect(of.rotor_radius_m, of.rotor_height_m + above_m);
}

// The disturbance, horizontally nearer to the time at which the tilt that is commanded now will have been reached.
// Slowly changing angles follow with the lag k_rate / k_angle.
Vector3d FlightController::Impl::expected_disturbance() const {
  Vector3d expected = disturbance.acceleration_ned();
  if (settings.rough_air.law != DisturbanceLaw::kLead) return expected;
  const double lag_s = gains.attitude_rate.head<2>().sum() / gains.attitude_angle.head<2>().sum();
  expected.head<2>() += kLeadShare * lag_s * disturbance.rate_ned().head<2>();
  const double squared = expected.squaredNorm();
  const double limit = gains.disturbance_limit;
  if (squared > limit * limit) expected *= limit / std::sqrt(squared);
  return expected;
}

// Eq. (48), then the map from its acceleration to thrust and attitude.
AttitudeDemand FlightController::Impl::follow_reference(bool integrate, double dt_s) {
  const Estimate& estimate = this->estimate();
  const PositionCommand wanted = position.step(estimate.position_ned, estimate.velocity_ned, reference, dt_s,
                                               !integrate || !controls_position());
  const ThrustAttitude outer =
      thrust_attitude(carried_mass_kg(), wanted.acceleration_ned - expected_disturbance(), max_tilt_tangent);
  if (heading.yaw_rad != reference.yaw_rad) heading = reference.yaw_rad;
  AttitudeDemand demand;
  demand.thrust_n = outer.thrust_n;
  demand.attitude.body_z_ned = outer.body_z_ned;
  demand.attitude.heading = heading;
  if (settings.attitude.feed_forward) {
    const ReferenceMotion on_reference = reference_motion(carried_mass_kg(), reference, heading);
    demand.attitude.body_rates = on_reference.body_rates;
    demand.attitude.body_accelerations = on_reference.body_accelerations;
    demand.thrust_n += thrust_lag_s() * on_reference.thrust_rate;  // leads the rotor lag
  }
  return demand;
}

// Level; where lift-off is observed, tilted as in flight as soon as the legs carry little enough.
AttitudeDemand FlightController::Impl::spool_up(double lift_fraction, double dt_s) {
  AttitudeDemand upright;
  if (observes_lift_off() && modelled_lift() > LiftObserver::kLeastLift)
    upright = follow_reference(false, dt_s);
  upright.thrust_n = lift_fraction * vehicle.mass_kg * plant::kGravity;
  upright.attitude.heading = reference.yaw_rad;
  return upright;
}

AttitudeDemand FlightController::Impl::descend_level(double speed) const {
  const Estimate& estimate = this->estimate();
  Vector3d acceleration_ned = -kBrakeGain * estimate.velocity_ned;
  acceleration_ned.z() = kDescentGain * (speed - estimate.velocity_ned.z());
  acceleration_ned = acceleration_ned.cwiseMax(-kDescentLimit).cwiseMin(kDescentLimit);
  const ThrustAttitude outer = thrust_attitude(carried_mass_kg(), acceleration_ned, max_tilt_tangent);
  AttitudeDemand braking;
  braking.thrust_n = outer.thrust_n;
  braking.attitude.body_z_ned = outer.body_z_ned;
  braking.attitude.heading = math::euler_angles(estimate.q_ned_from_frd).heading;
  return braking;
}

// The attitude of the setpoint, or its body rates at the present attitude.
AttitudeDemand FlightController::Impl::follow_direct_setpoint(const ControlSetpoint& setpoint) const {
  AttitudeDemand demand;
  demand.rates_only = setpoint.control_mode == ControlMode::kBodyRates;
  const Eigen::Quaterniond& q = demand.rates_only ? estimate().q_ned_from_frd : setpoint.q_ned_from_frd;
  demand.thrust_n = setpoint.specific_thrust * carried_mass_kg();
  demand.attitude.body_z_ned = body_z(q);
  demand.attitude.heading = math::euler_angles(q).heading;
  demand.attitude.body_rates = setpoint.body_rates_frd;
  return demand;
}

// Eq. (35)-(40). Uses the part of the thrust along the present body axis, and none while upside down.
Wrench FlightController::Impl::inner_loop(const AttitudeDemand& demand) const {
  const Estimate& estimate = this->estimate();
  Wrench wrench;
  if (demand.rates_only) {
    wrench.thrust_n = demand.thrust_n;
    wrench.moment_frd =
        attitude.moments_for_rates(estimate.body_rates_frd, rotors.moment_frd(), demand.attitude.body_rates);
    return wrench;
  }
  wrench.thrust_n = thrust_along_body(demand, estimate);
  wrench.moment_frd = attitude.moments(estimate.q_ned_from_frd, estimate.body_rates_frd, rotors.moment_frd(),
                                       demand.attitude);
  return wrench;
}

}  // namespace swiftlet::control

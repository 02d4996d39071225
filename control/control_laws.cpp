#include "swiftlet/control/control_laws.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/control/attitude/attitude_error.hpp"
#include "swiftlet/control/design/control_gains.hpp"
#include "swiftlet/control/position/thrust_attitude_map.hpp"
#include "swiftlet/math/euler.hpp"

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

ControlLaws::ControlLaws(const plant::Vehicle& vehicle, const ControlSettings& settings,
                         const ControlDesign& design)
    : mass_kg_(vehicle.mass_kg),
      rotor_lag_s_(design.rotor_lag_s),
      max_tilt_tangent_(std::tan(settings.limits.max_tilt_rad)),
      max_body_rate_(settings.limits.max_body_rate),
      feed_forward_(settings.attitude.feed_forward),
      rough_air_(settings.rough_air),
      position_(settings.position, settings.limits, design),
      attitude_(vehicle, settings.attitude, design),
      allocator_(vehicle),
      gains_(control_gains(design, settings)) {
  command_.rotor_count = vehicle.rotor_count();
  sent_ = command_;
  gain_change_.from = gain_change_.to = gains_;
  gain_change_.name = settings_name(settings.name);
}

void ControlLaws::begin_gain_change(const GainChange& change, std::int64_t now_ns) {
  gain_change_ = change;
  gain_change_.from = gains_;
  gain_change_.start_ns = now_ns;
  gains_are_constant_ = false;
}

bool ControlLaws::update_gains(std::int64_t now_ns, bool rotors_off) {
  if (gains_are_constant_) return false;
  if (rotors_off) gain_change_.duration_s = 0.0;
  gains_ = gain_change_.at(now_ns);
  position_.set_gains(gains_);
  attitude_.set_gains(gains_);
  gains_are_constant_ = gain_change_.progress(now_ns) >= 1.0;
  if (gains_are_constant_) gain_change_.duration_s = 0.0;  // has ended, also for a clock that starts again
  return true;
}

void ControlLaws::adopt(const FlightState& state) {
  position_.adopt(state.position_integral);
  command_.rotor_state = state.rotor_state;
  command_.throttle = state.throttle;
  gain_change_ = state.gains;
  gains_are_constant_ = false;
}

void ControlLaws::step(const ControlSetpoint& setpoint, const Observers& observers,
                       const Situation& situation, double dt_s) {
  const bool off = setpoint.control_mode == ControlMode::kOff;
  if (off || setpoint.control_mode == ControlMode::kIdle) {
    position_.reset();
    command_.rotor_state = off ? plant::RotorState::kOff : plant::RotorState::kRunning;
    attitude_setpoint_ = AttitudeSetpoint();
    saturated_ = false;
    return idle(observers, situation.level);
  }
  const Inputs in{setpoint, observers, situation, observers.estimate(), dt_s};
  const AttitudeDemand demand = outer_loop(in);
  command_.rotor_state = plant::RotorState::kRunning;
  if (situation.level == plant::ControlLevel::kActuators) {
    allocate(in, demand);
  } else {
    command_level(in, demand);
  }
}

AttitudeDemand ControlLaws::outer_loop(const Inputs& in) {
  switch (in.setpoint.control_mode) {
    case ControlMode::kSpoolUp:
      return spool_up(in);
    case ControlMode::kLevelDescent:
      return descend_level(in);
    case ControlMode::kAttitude:
    case ControlMode::kBodyRates:
      return follow_direct_setpoint(in);
    default:
      return follow_reference(in, in.setpoint.integrate);
  }
}

// The disturbance, horizontally nearer to the time at which the tilt that is commanded now will have been reached.
// Slowly changing angles follow with the lag k_rate / k_angle. m/s^2, NED.
Vector3d ControlLaws::expected_disturbance(const Observers& observers) const {
  Vector3d expected = observers.disturbance().acceleration_ned();
  if (rough_air_.law != DisturbanceLaw::kLead) return expected;
  const double lag_s = gains_.attitude_rate.head<2>().sum() / gains_.attitude_angle.head<2>().sum();
  expected.head<2>() += kLeadShare * lag_s * observers.disturbance().rate_ned().head<2>();
  const double squared = expected.squaredNorm();
  const double limit = gains_.disturbance_limit;
  if (squared > limit * limit) expected *= limit / std::sqrt(squared);
  return expected;
}

// The thrust command leads the observed thrust by this, so that the thrust follows with less lag.
double ControlLaws::thrust_lead(const Situation& situation) const {
  return situation.level == plant::ControlLevel::kActuators ? rough_air_.thrust_lead : 0.0;
}

// Eq. (48), then the map from its acceleration to thrust and attitude.
AttitudeDemand ControlLaws::follow_reference(const Inputs& in, bool integrate) {
  const Reference& reference = in.setpoint.reference;
  const PositionCommand wanted = position_.step(in.estimate.position_ned, in.estimate.velocity_ned, reference,
                                                in.dt_s, !integrate || !in.situation.controls_position());
  const double mass_kg = in.observers.carried_mass_kg(in.situation);
  const ThrustAttitude outer = thrust_attitude(
      mass_kg, wanted.acceleration_ned - expected_disturbance(in.observers), max_tilt_tangent_);
  if (heading_.yaw_rad != reference.yaw_rad) heading_ = reference.yaw_rad;
  AttitudeDemand demand;
  demand.thrust_n = outer.thrust_n;
  demand.attitude.body_z_ned = outer.body_z_ned;
  demand.attitude.heading = heading_;
  if (feed_forward_) {
    const ReferenceMotion on_reference = reference_motion(mass_kg, reference, heading_);
    demand.attitude.body_rates = on_reference.body_rates;
    demand.attitude.body_accelerations = on_reference.body_accelerations;
    const double thrust_lag_s = rotor_lag_s_ / (1.0 + thrust_lead(in.situation));
    demand.thrust_n += thrust_lag_s * on_reference.thrust_rate;  // leads the rotor lag
  }
  return demand;
}

// Level; where lift-off is observed, tilted as in flight as soon as the legs carry little enough.
AttitudeDemand ControlLaws::spool_up(const Inputs& in) {
  AttitudeDemand upright;
  if (in.observers.observes_lift_off(in.situation) &&
      in.observers.modelled_lift(in.situation) > LiftObserver::kLeastLift)
    upright = follow_reference(in, false);
  upright.thrust_n = in.setpoint.lift_fraction * mass_kg_ * plant::kGravity;
  upright.attitude.heading = in.setpoint.reference.yaw_rad;
  return upright;
}

AttitudeDemand ControlLaws::descend_level(const Inputs& in) const {
  Vector3d acceleration_ned = -kBrakeGain * in.estimate.velocity_ned;
  acceleration_ned.z() = kDescentGain * (in.setpoint.descent_speed - in.estimate.velocity_ned.z());
  acceleration_ned = acceleration_ned.cwiseMax(-kDescentLimit).cwiseMin(kDescentLimit);
  const ThrustAttitude outer =
      thrust_attitude(in.observers.carried_mass_kg(in.situation), acceleration_ned, max_tilt_tangent_);
  AttitudeDemand braking;
  braking.thrust_n = outer.thrust_n;
  braking.attitude.body_z_ned = outer.body_z_ned;
  braking.attitude.heading = math::euler_angles(in.estimate.q_ned_from_frd).heading;
  return braking;
}

// The attitude of the setpoint, or its body rates at the present attitude.
AttitudeDemand ControlLaws::follow_direct_setpoint(const Inputs& in) const {
  AttitudeDemand demand;
  demand.rates_only = in.setpoint.control_mode == ControlMode::kBodyRates;
  const Eigen::Quaterniond& q = demand.rates_only ? in.estimate.q_ned_from_frd : in.setpoint.q_ned_from_frd;
  demand.thrust_n = in.setpoint.specific_thrust * in.observers.carried_mass_kg(in.situation);
  demand.attitude.body_z_ned = body_z(q);
  demand.attitude.heading = math::euler_angles(q).heading;
  demand.attitude.body_rates = in.setpoint.body_rates_frd;
  return demand;
}

// Eq. (35)-(40). Uses the part of the thrust along the present body axis, and none while upside down.
Wrench ControlLaws::inner_loop(const Inputs& in, const AttitudeDemand& demand) const {
  const Vector3d rotor_moment_frd = in.observers.rotor_moment_frd();
  Wrench wrench;
  if (demand.rates_only) {
    wrench.thrust_n = demand.thrust_n;
    wrench.moment_frd =
        attitude_.moments_for_rates(in.estimate.body_rates_frd, rotor_moment_frd, demand.attitude.body_rates);
    return wrench;
  }
  wrench.thrust_n = thrust_along_body(demand, in.estimate);
  wrench.moment_frd = attitude_.moments(in.estimate.q_ned_from_frd, in.estimate.body_rates_frd,
                                        rotor_moment_frd, demand.attitude);
  return wrench;
}

void ControlLaws::allocate(const Inputs& in, const AttitudeDemand& demand) {
  Wrench wrench = inner_loop(in, demand);
  wrench.moment_frd -= in.observers.unexplained_moment_frd();
  wrench.thrust_n += thrust_lead(in.situation) * (wrench.thrust_n - in.observers.rotor_thrust_n());
  const Allocation allocation =
      allocator_.allocate(wrench, allocator_.supply_at(in.observers.rotor_voltage_v()));
  command_.throttle = allocation.throttle;
  attitude_setpoint_ = {demand.attitude.body_z_ned, demand.attitude.heading.yaw_rad, wrench.thrust_n,
                        wrench.moment_frd};
  saturated_ = allocation.saturated;
}

void ControlLaws::command_level(const Inputs& in, const AttitudeDemand& demand) {
  command_.throttle = plant::PerRotor{};
  thrust_n_ = std::max(demand.rates_only ? demand.thrust_n : thrust_along_body(demand, in.estimate), 0.0);
  attitude_setpoint_ = {demand.attitude.body_z_ned, demand.attitude.heading.yaw_rad, thrust_n_,
                        Vector3d::Zero()};
  saturated_ = false;  // not known
  if (in.situation.level == plant::ControlLevel::kRates) {
    send(rates_command(demand, thrust_n_, in.estimate, attitude_, max_body_rate_), in.observers);
  } else if (in.situation.level == plant::ControlLevel::kAttitude) {
    send(attitude_command(demand, thrust_n_, in.estimate), in.observers);
  } else {
    send(trajectory_command(in.setpoint, in.estimate), in.observers);
  }
}

void ControlLaws::idle(const Observers& observers, plant::ControlLevel level) {
  command_.throttle = plant::PerRotor{};
  if (level == plant::ControlLevel::kActuators) return;
  thrust_n_ = 0.0;
  send(idle_command(level, observers.estimate()), observers);
}

// The vehicle obeys in the frame of its own estimate.
void ControlLaws::send(const plant::VehicleCommand& in_own_frame, const Observers& observers) {
  const EstimateSource* const odometry = observers.odometry();
  sent_ = odometry != nullptr ? in_vehicle_frame(in_own_frame, *odometry) : in_own_frame;
}

const plant::VehicleCommand& ControlLaws::answer(const plant::ImuSample& sample, std::uint64_t pose_sequence,
                                                 plant::ControlLevel level) {
  command_.stamp_ns = sample.stamp_ns;
  command_.imu_sequence = sample.sequence;
  command_.mocap_sequence = pose_sequence;
  ++command_.sequence;
  if (level == plant::ControlLevel::kActuators) {
    sent_ = command_;
  } else {
    plant::header_of(sent_) = command_;
  }
  return sent_;
}

}  // namespace swiftlet::control

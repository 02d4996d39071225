#include "swiftlet/control/observers.hpp"

#include <algorithm>
#include <limits>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/rotor.hpp"

namespace swiftlet::control {
namespace {

using Eigen::Vector3d;

constexpr double kFirstStep_s = 0.002;  // assumed for the first sample
constexpr double kMaxStep_s = 0.1;
constexpr int kUnusableToFault = 200;  // unusable IMU samples in a row to a fault, whatever their stamps

// Fraction of the weight: above this specific force that the rotors do not explain, something else carries
// the vehicle, on its legs or on its side.
constexpr double kStandingLift = 0.5;

// N m about each axis: of rotors in hover, those on one side at no thrust and the others at twice theirs.
Vector3d differential_moment(const plant::Vehicle& vehicle) {
  return plant::effectiveness(vehicle).bottomRows<3>().cwiseAbs().rowwise().sum() *
         plant::hover_thrust(vehicle);
}

}  // namespace

Observers::Observers(const plant::Vehicle& vehicle, const ControlSettings& settings)
    : vehicle_(vehicle),
      settings_(settings.estimator),
      rough_air_(settings.rough_air),
      mocap_timeout_s_(settings.failsafe.mocap_timeout_s),
      imu_timeout_s_(settings.failsafe.imu_timeout_s),
      bandwidth_(settings.disturbance.bandwidth),
      plausible_supply_(Allocator(vehicle).plausible_supply()),
      estimator_(settings_),
      estimate_source_(settings_.odometry, mocap_timeout_s_),
      poses_ahead_(settings_.detectors.recovery.longest_wait_s),
      rotors_(vehicle, settings_.rotor_speed_bandwidth),
      disturbance_(settings.disturbance, rough_air_.law == DisturbanceLaw::kIncremental),
      moment_(vehicle.inertia, differential_moment(vehicle)),
      takeoff_monitor_(settings_.detectors.takeoff_consistency),
      supply_voltage_v_(plausible_supply_.assumed),
      supply_observer_(vehicle, supply_voltage_v_),
      rotor_voltage_v_(supply_voltage_v_) {}

void Observers::restart() {
  estimator_ = Estimator(settings_);
  odometry_motion_ = OdometryMotion();
  estimate_source_ = EstimateSource(settings_.odometry, mocap_timeout_s_);
  poses_ahead_.clear();
  rotors_ = RotorObserver(vehicle_, settings_.rotor_speed_bandwidth);
  sent_commands_ = SentCommands();
  last_stamp_ns_ = 0;
  has_battery_ = false;
}

bool Observers::predict(const plant::ImuSample& sample, plant::RotorState rotor_state) {
  brings_odometry_ = false;
  if (!estimator_.predict(sample)) return false;
  fuse_waiting_poses(sample.stamp_ns, rotor_state);
  return true;
}

std::optional<plant::ImuSample> Observers::predict(const plant::OdometrySample& sample,
                                                   plant::RotorState rotor_state,
                                                   const Situation& situation) {
  brings_odometry_ = true;
  const bool finite = sample.q_ned_from_frd.coeffs().allFinite() && sample.body_rates_frd.allFinite();
  if (!finite || sample.stamp_ns <= last_stamp_ns_) return std::nullopt;
  const MeanMotion mean = odometry_motion_.step(sample, lift_now(situation));
  const plant::ImuSample imu{sample.stamp_ns, sample.sequence, mean.specific_force_frd,
                             sample.body_rates_frd};
  if (!estimator_.predict(imu, mean)) return std::nullopt;
  fuse_waiting_poses(sample.stamp_ns, rotor_state);
  estimate_source_.update(sample, mean.specific_force_frd, estimator_, rotor_state);
  return imu;
}

void Observers::fuse_waiting_poses(std::int64_t stamp_ns, plant::RotorState rotor_state) {
  while (const auto pose = poses_ahead_.take(stamp_ns)) estimator_.correct(*pose, rotor_state);
}

void Observers::on_pose(const plant::PoseSample& sample, plant::RotorState rotor_state) {
  const std::int64_t now_ns = estimator_.estimate().stamp_ns;
  if (now_ns > 0 && poses_ahead_.keep(sample, now_ns)) return;
  estimator_.correct(sample, rotor_state);
}

void Observers::on_battery(const plant::BatterySample& sample) {
  const bool plausible =
      sample.voltage_v >= plausible_supply_.min && sample.voltage_v <= plausible_supply_.max;
  implausible_supply_v_ = plausible ? 0.0 : sample.voltage_v;
  if (!plausible) return;
  has_battery_ = true;
  battery_stamp_ns_ = sample.stamp_ns;
  supply_voltage_v_ = sample.voltage_v;
  supply_observer_.correct(sample.voltage_v);
}

// By the stamps. The count of samples covers a clock that stands still. A clock that goes far back is that of a restarted
// vehicle, which must not receive this flight's commands.
double Observers::count_unusable(bool usable, std::int64_t stamp_ns) {
  unusable_samples_ = usable ? 0 : unusable_samples_ + 1;
  if (unusable_samples_ == 1) unusable_since_ns_ = std::min(stamp_ns, last_stamp_ns_);
  unusable_s_ = usable ? 0.0 : math::seconds(stamp_ns - unusable_since_ns_);
  const bool started_again = math::seconds(last_stamp_ns_ - stamp_ns) > imu_timeout_s_;
  if (unusable_samples_ >= kUnusableToFault || started_again)
    unusable_s_ = std::numeric_limits<double>::infinity();
  return unusable_s_;
}

double Observers::store_sample(const plant::ImuSample& sample, const plant::ActuatorCommand& command,
                               plant::ControlLevel level) {
  if (!has_battery_ && last_stamp_ns_ == 0)
    battery_stamp_ns_ = sample.stamp_ns;  // starts the battery time-out
  imu_gap_s_ = last_stamp_ns_ == 0 ? kFirstStep_s : math::seconds(sample.stamp_ns - last_stamp_ns_);
  const double dt_s = std::min(imu_gap_s_, kMaxStep_s);
  last_stamp_ns_ = sample.stamp_ns;
  specific_force_frd_ = sample.specific_force_frd;
  sent_commands_.sample(sample.stamp_ns, dt_s, obeyed_);
  if (level == plant::ControlLevel::kActuators) {
    supply_observer_.step(dt_s, command, rotors_.speeds());
    rotor_voltage_v_ = supply_observer_.voltage_v();
    rotors_.step(dt_s, command, rotor_voltage_v_);
  } else {
    rotors_.step(dt_s, sent_commands_.obeyed_thrust_n());
  }
  return dt_s;
}

void Observers::observe(const ControlSetpoint& setpoint, double dt_s, const Situation& situation) {
  const Estimate& estimate = this->estimate();
  switch (setpoint.control_mode) {
    case ControlMode::kOff:
    case ControlMode::kIdle:
      disturbance_.reset();
      moment_.reset();
      lift_.reset();
      return;
    case ControlMode::kSpoolUp:
      takeoff_monitor_.begin(estimate.accelerometer_bias, estimate.position_ned.z());
      if (!observes_lift_off(situation)) return;
      lift_.step_on_ground(dt_s, unbiased_force_frd(), estimate.q_ned_from_frd, modelled_lift(situation));
      lift_off_ns_ = last_stamp_ns_;
      observe_sliding(dt_s, situation);
      return;
    case ControlMode::kLevelDescent:
      // On the ground the moment comes from the contact, and is no disturbance.
      if (!situation.in_contact) observe_moment(dt_s);
      return;
    case ControlMode::kFly:
    case ControlMode::kAttitude:
    case ControlMode::kBodyRates:
      takeoff_monitor_.step(dt_s, specific_force_frd_, estimate.q_ned_from_frd, estimate.position_ned.z());
      if (!setpoint.integrate || !situation.controls_position()) return;
      if (rough_air_.learn_lift) lift_.step_in_flight(dt_s, unbiased_force_frd(), modelled_lift(situation));
      observe_moment(dt_s);
      disturbance_.step(dt_s, unbiased_force_frd(), estimate.q_ned_from_frd, lift_now(situation));
      return;
  }
}

// Needs no position.
void Observers::observe_moment(double dt_s) {
  if (rough_air_.law == DisturbanceLaw::kIncremental)
    moment_.step(dt_s, bandwidth_, estimate().body_rates_frd, rotors_.moment_frd());
}

// On the ground the contact hides the vertical disturbance. The horizontal one shows once the vehicle slides.
void Observers::observe_sliding(double dt_s, const Situation& situation) {
  if (modelled_lift(situation) < LiftObserver::kLeastLift) return;
  const Vector3d force_frd = unbiased_force_frd();
  disturbance_.step(dt_s, force_frd, estimate().q_ned_from_frd, -force_frd.z());
}

void Observers::set_gains(const ControlGains& gains) {
  bandwidth_ = gains.disturbance_bandwidth;
  disturbance_.set({gains.disturbance_bandwidth, gains.disturbance_limit});
}

void Observers::adopt(double lift_ratio, std::int64_t now_ns) {
  lift_.reset();
  if (!(lift_ratio > 0.0)) return;
  lift_.adopt(lift_ratio);
  lift_off_ns_ = now_ns;
}

// airborne: by height, where lift-off is not observed.
HoverTestStep Observers::hover_test_step(const Situation& situation, double dt_s, bool airborne) const {
  const Estimate& now = estimate();
  HoverTestStep step;
  step.stamp_ns = last_stamp_ns_;
  step.dt_s = dt_s;
  step.ground_z_ned = situation.ground_z_ned;
  step.position_ned = now.position_ned;
  step.velocity_ned = now.velocity_ned;
  step.q_ned_from_frd = now.q_ned_from_frd;
  step.body_rates_frd = now.body_rates_frd;
  step.specific_force_frd = unbiased_force_frd();
  step.rotor_speeds = rotors_.speeds();
  step.commands_rotors = situation.level == plant::ControlLevel::kActuators;
  step.lifted_off = observes_lift_off(situation) ? lift_.lifted_off() : airborne;
  step.lift_ratio = lift_.ratio();
  return step;
}

SupervisorInputs Observers::supervisor_inputs(const Situation& situation) const {
  SupervisorInputs inputs;
  const Estimate& estimate = this->estimate();
  inputs.stamp_ns = estimate.stamp_ns;
  inputs.estimate = &estimate;
  inputs.has_estimate = brings_odometry_ ? estimate_source_.initialised() : estimator_.initialised();
  inputs.pose_age_s = brings_odometry_ ? estimate_source_.position_age_s() : estimator_.pose_age_s();
  inputs.estimate_of_vehicle = brings_odometry_ && estimate_source_.is_vehicles();
  inputs.brings_odometry = brings_odometry_;
  inputs.has_battery = has_battery_;
  inputs.supply_voltage_v = supply_voltage_v_;
  inputs.implausible_supply_v = implausible_supply_v_;
  inputs.least_supply_v = plausible_supply_.min;
  inputs.most_supply_v = plausible_supply_.max;
  inputs.battery_age_s = math::seconds(estimate.stamp_ns - battery_stamp_ns_);
  inputs.vertical_specific_force_residual =
      -(specific_force_frd_.z() - estimate.accelerometer_bias.z()) - lift_now(situation);
  if (observes_lift_off(situation)) inputs.lift_off_ns = lift_.lifted_off() ? lift_off_ns_ : kNoLiftOffYet;
  inputs.command_delay_s = sent_commands_.delay_s();
  inputs.takeoff_inconsistent = takeoff_monitor_.contradicted();
  inputs.specific_force_frd = specific_force_frd_;
  inputs.rotor_speed = *std::max_element(rotors_.speeds().begin(), rotors_.speeds().end());
  inputs.imu_unusable_s = unusable_s_;
  inputs.imu_gap_s = imu_gap_s_;
  return inputs;
}

ErrorState Observers::estimate_deviation() const {
  return brings_odometry_ ? estimate_source_.standard_deviation(estimator_) : estimator_.standard_deviation();
}

double Observers::ground_effect_now(const Situation& situation) const {
  if (!(rough_air_.rotor_radius_m > 0.0)) return 1.0;
  const double above_m = situation.ground_z_ned - estimate().position_ned.z();
  return plant::ground_effect(rough_air_.rotor_radius_m, rough_air_.rotor_height_m + above_m);
}

double Observers::modelled_lift(const Situation& situation) const {
  return ground_effect_now(situation) * rotors_.thrust_n() / vehicle_.mass_kg;
}

double Observers::carried_mass_kg(const Situation& situation) const {
  return vehicle_.mass_kg / (lift_.ratio() * ground_effect_now(situation));
}

bool Observers::airborne(const Situation& situation) const {
  const Vector3d lift_frd(0.0, 0.0, -lift_now(situation));
  const Vector3d unexplained = specific_force_frd_ - estimate().accelerometer_bias - lift_frd;
  return unexplained.norm() < kStandingLift * plant::kGravity;
}

}  // namespace swiftlet::control

#include "swiftlet/plant/simulation/plant_simulation.hpp"

#include <limits>

#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/battery.hpp"

namespace swiftlet::plant {

namespace {

Vehicle with_drag(Vehicle vehicle, const SimulationSettings& settings) {
  if (!settings.air.drag) vehicle.linear_drag = 0.0;
  return vehicle;
}

RotorAir rotor_air_of(const SimulationSettings& settings) {
  return {settings.air.rotor_drag, settings.ground.present ? settings.ground.effect_rotor_radius_m : 0.0,
          settings.ground.leg_height_m};
}

Supply supply_of(const Vehicle& vehicle, const SupplySettings& settings) {
  return settings.ideal
             ? Supply::constant(open_circuit_voltage(vehicle.battery, settings.initial_state_of_charge))
             : Supply::battery();
}

}  // namespace

PlantSimulation::PlantSimulation(const Vehicle& vehicle, const SimulationSettings& settings,
                                 std::uint64_t seed, const VehicleState& initial)
    : dynamics_(with_drag(vehicle, settings), supply_of(vehicle, settings.supply), rotor_air_of(settings)),
      ground_(vehicle, settings.ground),
      air_(settings.air, static_cast<double>(settings.step_ns) / math::kNsPerS, seed),
      imu_(settings.imu, seed),
      step_ns_(settings.step_ns),
      step_s_(static_cast<double>(settings.step_ns) / math::kNsPerS),
      rotor_count_(vehicle.rotor_count()),
      faults_(settings.faults),
      fault_change_ns_(faults_.next_change_ns(-1)),
      wind_ned_(air_.wind_ned()),
      state_(initial),
      imu_schedule_{period_ns(settings.imu.rate_hz) / settings.step_ns},
      battery_schedule_{period_ns(settings.supply.rate_hz) / settings.step_ns},
      rotor_speed_schedule_{period_ns(settings.rotor_speed_rate_hz) / settings.step_ns} {
  state_.q_ned_from_frd.normalize();
  state_.state_of_charge = settings.supply.initial_state_of_charge;
  state_.sag_v = 0.0;
  on_ground_ = !ground_.out_of_reach(state_.position_ned.z()) && ground_.clearance(state_) <= 0.0;
  if (on_ground_) {
    // The floor carries the weight that the rotors do not.
    contact_sum_ned_ =
        -state_.q_ned_from_frd._transformVector(dynamics_.specific_force_frd(state_, wind_ned_));
    contact_sum_ned_.z() -= kGravity;
    contact_steps_ = 1;
  }
  sample({});
}

void PlantSimulation::step(const MotorCommand& drive) {
  if (stamp_ns_ >= fault_change_ns_) change_faults();
  air_.advance();
  wind_ned_ = air_.wind_ned() + fault_wind_ned_;
  const GroundContact::ContactState before{state_.position_ned, state_.q_ned_from_frd};
  dynamics_.advance(state_, drive, wind_ned_, step_s_);
  on_ground_ = false;
  if (!ground_.out_of_reach(state_.position_ned.z())) {
    Eigen::Vector3d acceleration_ned = Eigen::Vector3d::Zero();
    on_ground_ = ground_.resolve(before, state_, step_s_, acceleration_ned);
    contact_sum_ned_ += acceleration_ned;
  }
  ++contact_steps_;
  ++steps_;
  stamp_ns_ += step_ns_;
  sample(drive);
}

// Applies the faults that are active from this stamp on.
void PlantSimulation::change_faults() {
  Disturbance disturbance;
  if (const Fault* push = faults_.active(FaultKind::kPush, stamp_ns_)) {
    disturbance.force_ned = push->force_ned;
    disturbance.moment_frd = push->moment_frd;
  }
  if (const Fault* drop = faults_.active(FaultKind::kBatteryDrop, stamp_ns_))
    disturbance.supply_drop_v = drop->voltage_v;
  if (const Fault* rotor = faults_.active(FaultKind::kRotorThrust, stamp_ns_))
    disturbance.rotor_factors[static_cast<std::size_t>(rotor->rotor - 1)] = rotor->factor;
  dynamics_.disturb(disturbance);
  const Fault* wind = faults_.active(FaultKind::kWind, stamp_ns_);
  fault_wind_ned_ = wind != nullptr ? wind->wind_ned : Eigen::Vector3d(Eigen::Vector3d::Zero());
  fault_change_ns_ = faults_.next_change_ns(stamp_ns_);
}

void PlantSimulation::sample(const MotorCommand& drive) {
  imu_sample_.reset();
  samples_ = {};
  imu_due_ = imu_schedule_.due();
  if (imu_due_) sample_imu();
  if (battery_schedule_.due() && faults_.active(FaultKind::kBatteryStop, stamp_ns_) == nullptr) {
    samples_.battery = BatterySample{stamp_ns_, battery_schedule_.sequence, dynamics_.supply_voltage(state_),
                                     dynamics_.supply_current(state_, drive), state_.state_of_charge};
  }
  if (rotor_speed_schedule_.due() && faults_.active(FaultKind::kRotorSpeedsStop, stamp_ns_) == nullptr) {
    samples_.rotor_speeds =
        RotorSpeedSample{stamp_ns_, rotor_speed_schedule_.sequence, rotor_count_, state_.rotor_speeds};
  }
}

// Faults modify a sample after it is drawn, so that they do not change later draws.
void PlantSimulation::sample_imu() {
  ImuSample sample = imu_.sample(stamp_ns_, specific_force_frd(), state_.body_rates_frd);
  if (faults_.empty()) {
    imu_sample_ = sample;
    return;
  }
  if (const Fault* bias = faults_.active(FaultKind::kImuBias, stamp_ns_)) {
    sample.specific_force_frd += bias->specific_force_frd;
    sample.body_rates_frd += bias->body_rates_frd;
  }
  if (faults_.active(FaultKind::kImuStuck, stamp_ns_) == nullptr) {
    last_sound_imu_ = sample;
  } else {
    sample.specific_force_frd = last_sound_imu_.specific_force_frd;
    sample.body_rates_frd = last_sound_imu_.body_rates_frd;
  }
  if (faults_.active(FaultKind::kImuNan, stamp_ns_) != nullptr) {
    sample.specific_force_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
    sample.body_rates_frd.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  if (faults_.active(FaultKind::kImuStop, stamp_ns_) == nullptr) imu_sample_ = sample;
}

// Rotor and air forces are instantaneous. The contact force is the mean since the last sample, because
// impacts are shorter than a sample period.
Eigen::Vector3d PlantSimulation::specific_force_frd() {
  Eigen::Vector3d specific_force = dynamics_.specific_force_frd(state_, wind_ned_);
  if (!contact_sum_ned_.isZero(0.0)) {
    specific_force +=
        state_.q_ned_from_frd.conjugate() * (contact_sum_ned_ / static_cast<double>(contact_steps_));
  }
  contact_sum_ned_.setZero();
  contact_steps_ = 0;
  return specific_force;
}

TruthSample PlantSimulation::truth() const {
  TruthSample truth;
  truth.stamp_ns = stamp_ns_;
  truth.sequence = steps_ + 1;
  truth.position_ned = state_.position_ned;
  truth.velocity_ned = state_.velocity_ned;
  truth.q_ned_from_frd = state_.q_ned_from_frd;
  truth.body_rates_frd = state_.body_rates_frd;
  truth.rotor_count = rotor_count_;
  truth.rotor_speeds = state_.rotor_speeds;
  truth.supply_voltage_v = dynamics_.supply_voltage(state_);
  truth.on_ground = on_ground_;
  return truth;
}

}  // namespace swiftlet::plant

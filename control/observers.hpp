// What the controller knows of the vehicle from its samples: state, rotors, supply, lift, and the forces and moments that the rotors
// do not explain.
//
// In: samples in SI units, in FRD or NED as their types say, with stamps of the vehicle's clock, ns; and the commands that were sent.
// Out: what the accessors name, at the stamp of the last usable sample. No clock, no heap after construction.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/estimation/disturbance_observer.hpp"
#include "swiftlet/control/estimation/estimate_source.hpp"
#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/estimation/lift_observer.hpp"
#include "swiftlet/control/estimation/moment_observer.hpp"
#include "swiftlet/control/estimation/odometry_motion.hpp"
#include "swiftlet/control/estimation/poses_ahead.hpp"
#include "swiftlet/control/estimation/rotor_observer.hpp"
#include "swiftlet/control/estimation/sent_commands.hpp"
#include "swiftlet/control/estimation/supply_observer.hpp"
#include "swiftlet/control/estimation/takeoff_consistency.hpp"
#include "swiftlet/control/supervision/hover_test.hpp"
#include "swiftlet/control/supervision/supervisor_inputs.hpp"
#include "swiftlet/control/types/gains.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"

namespace swiftlet::control {

// What holds of the vehicle beside its samples: the level at which it is commanded, and what the supervisor knows of the ground.
struct Situation {
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  double ground_z_ned = 0.0;  // m
  bool in_contact = false;    // touchdown signs hold

  // At level trajectory the vehicle does it.
  bool controls_position() const { return level != plant::ControlLevel::kTrajectory; }
};

class Observers {
 public:
  Observers(const plant::Vehicle& vehicle, const ControlSettings& settings);

  // For a restarted vehicle, which counts its time from 0 again.
  void restart();

  // Propagates the estimate to the sample, and fuses the poses that waited for it. rotor_state: of the last command. Returns false
  // for a sample that is not usable.
  bool predict(const plant::ImuSample& sample, plant::RotorState rotor_state);
  // The same with the vehicle's own estimate. Returns it as a sample of an IMU; nullopt if it is not usable.
  std::optional<plant::ImuSample> predict(const plant::OdometrySample& sample, plant::RotorState rotor_state,
                                          const Situation& situation);
  // Call after predict(), with its result. Returns for how long no sample was usable, s; infinite once that is a fault whatever
  // the stamps say.
  double count_unusable(bool usable, std::int64_t stamp_ns);
  // Stores a usable sample and runs the rotor model up to it. command: the last one. Returns the time since the last
  // sample, s, at most 0.1 s.
  double store_sample(const plant::ImuSample& sample, const plant::ActuatorCommand& command,
                      plant::ControlLevel level);
  // Updates the monitor and the observers that run in flight, in every control mode, over dt_s.
  void observe(const ControlSetpoint& setpoint, double dt_s, const Situation& situation);

  void on_pose(const plant::PoseSample& sample, plant::RotorState rotor_state);
  void on_battery(const plant::BatterySample& sample);
  void on_rotor_speeds(const plant::RotorSpeedSample& sample) { rotors_.correct(sample); }
  void set_obeyed(const plant::ObeyedCommand& obeyed) { obeyed_ = obeyed; }
  // The command that answers the sample of this stamp has this collective thrust, N.
  void sent(std::int64_t stamp_ns, double thrust_n) { sent_commands_.sent(stamp_ns, thrust_n); }
  void set_gains(const ControlGains& gains);
  // Takes over the lift that another controller learnt; 0: it has not lifted off.
  void adopt(double lift_ratio, std::int64_t now_ns);

  HoverTestStep hover_test_step(const Situation& situation, double dt_s, bool airborne) const;

  // All that supervision has to know of these; the rest keeps its default.
  SupervisorInputs supervisor_inputs(const Situation& situation) const;

  std::int64_t stamp_ns() const { return last_stamp_ns_; }  // of the last usable sample; 0: none
  // The estimate at that sample: the controller's own, or that of a vehicle that brings one.
  const Estimate& estimate() const {
    return brings_odometry_ ? estimate_source_.estimate() : estimator_.estimate();
  }
  ErrorState estimate_deviation() const;
  std::uint64_t pose_sequence() const { return estimator_.pose_sequence(); }
  // The estimate that the vehicle brings itself; null if it brings none.
  const EstimateSource* odometry() const { return brings_odometry_ ? &estimate_source_ : nullptr; }

  double rotor_thrust_n() const { return rotors_.thrust_n(); }
  Eigen::Vector3d rotor_moment_frd() const { return rotors_.moment_frd(); }  // N m
  double rotor_voltage_v() const { return rotor_voltage_v_; }                // of the supply, with its sag
  Eigen::Vector3d unexplained_moment_frd() const { return moment_.moment_frd(); }  // N m
  const DisturbanceObserver& disturbance() const { return disturbance_; }
  bool observes_lift_off(const Situation& situation) const {
    return rough_air_.learn_lift && situation.controls_position();
  }
  // With learnt lift and ground effect: modelled lift (m/s^2) of the rotors now, over that of the vehicle file,
  // and the mass that the commanded thrust is to carry.
  double modelled_lift(const Situation& situation) const;
  double lift_now(const Situation& situation) const { return lift_.ratio() * modelled_lift(situation); }
  double carried_mass_kg(const Situation& situation) const;
  double lift_ratio() const { return lift_.lifted_off() ? lift_.ratio() : 0.0; }  // 0: not lifted off
  // True if nothing but the rotors carries the vehicle, by accelerometer and rotor speeds.
  bool airborne(const Situation& situation) const;

 private:
  double ground_effect_now(const Situation& situation) const;
  Eigen::Vector3d unbiased_force_frd() const { return specific_force_frd_ - estimate().accelerometer_bias; }
  void fuse_waiting_poses(std::int64_t stamp_ns, plant::RotorState rotor_state);
  void observe_moment(double dt_s);
  void observe_sliding(double dt_s, const Situation& situation);

  plant::Vehicle vehicle_;
  EstimatorSettings settings_;
  RoughAirSettings rough_air_;
  double mocap_timeout_s_;
  double imu_timeout_s_;
  double bandwidth_;  // rad/s, of the disturbance, in force
  Allocator::SupplyRange plausible_supply_;
  double implausible_supply_v_ = 0.0;  // the last one, since the last plausible one; 0: none

  Estimator estimator_;
  OdometryMotion odometry_motion_;
  EstimateSource estimate_source_;
  bool brings_odometry_ = false;  // the vehicle, in place of IMU samples
  PosesAhead poses_ahead_;
  RotorObserver rotors_;
  LiftObserver lift_;
  std::int64_t lift_off_ns_ = 0;  // stamp of the lift-off; 0: not yet
  DisturbanceObserver disturbance_;
  MomentObserver moment_;  // of the incremental law
  TakeoffConsistencyMonitor takeoff_monitor_;

  std::int64_t last_stamp_ns_ = 0;
  int unusable_samples_ = 0;            // in a row
  std::int64_t unusable_since_ns_ = 0;  // the last stamp before them, or the one after time went back
  double unusable_s_ = 0.0;
  double imu_gap_s_ = 0.0;  // between the last two usable samples
  Eigen::Vector3d specific_force_frd_ = Eigen::Vector3d::Zero();

  bool has_battery_ = false;
  std::int64_t battery_stamp_ns_ = 0;
  double supply_voltage_v_;
  SupplyObserver supply_observer_;
  double rotor_voltage_v_;
  plant::ObeyedCommand obeyed_;  // as the vehicle reports
  SentCommands sent_commands_;
};

}  // namespace swiftlet::control

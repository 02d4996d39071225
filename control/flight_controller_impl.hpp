// The stages of the controller's step and its state, for the files flight_controller*.cpp.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/control/allocation/allocator.hpp"
#include "swiftlet/control/attitude/attitude_controller.hpp"
#include "swiftlet/control/estimation/disturbance_observer.hpp"
#include "swiftlet/control/estimation/estimate_source.hpp"
#include "swiftlet/control/estimation/lift_observer.hpp"
#include "swiftlet/control/estimation/moment_observer.hpp"
#include "swiftlet/control/estimation/odometry_motion.hpp"
#include "swiftlet/control/estimation/poses_ahead.hpp"
#include "swiftlet/control/estimation/rotor_observer.hpp"
#include "swiftlet/control/estimation/sent_commands.hpp"
#include "swiftlet/control/estimation/supply_observer.hpp"
#include "swiftlet/control/estimation/takeoff_consistency.hpp"
#include "swiftlet/control/flight_controller.hpp"
#include "swiftlet/control/level_commands.hpp"
#include "swiftlet/control/position/position_controller.hpp"
#include "swiftlet/control/supervision/supervisor.hpp"

namespace swiftlet::control {

struct FlightController::Impl {
  Impl(const plant::Vehicle& vehicle_in, const ControlSettings& settings_in, const ControlDesign& design_in);

  // The stages of a step, in order.
  void restart_if_clock_went_back(std::int64_t stamp_ns);
  bool predict(const plant::ImuSample& sample);
  std::optional<plant::ImuSample> predict(const plant::OdometrySample& sample);
  void count_unusable(bool usable, std::int64_t stamp_ns);
  double store_sample(const plant::ImuSample& sample);
  SupervisorInputs inputs() const;
  void observe(const ControlSetpoint& setpoint, double dt_s);
  void observe_sliding(double dt_s);
  void observe_moment(double dt_s);
  AttitudeDemand outer_loop(const ControlSetpoint& setpoint, double dt_s);
  Wrench inner_loop(const AttitudeDemand& demand) const;
  void command_vehicle(const ControlSetpoint& setpoint, const AttitudeDemand& demand);
  void idle_rotors(plant::RotorState rotor_state);
  void send_idle();
  void report(const SupervisorInputs& inputs);
  const plant::VehicleCommand& step(const plant::ImuSample& sample, bool usable, ClientInputs& clients);
  const plant::VehicleCommand& stamp_command(const plant::ImuSample& sample);

  // The estimate at the last sample: the controller's own, or that of a vehicle that brings one.
  const Estimate& estimate() const {
    return brings_odometry ? estimate_source.estimate() : estimator.estimate();
  }
  void send(const plant::VehicleCommand& in_own_frame);

  void allocate(const AttitudeDemand& demand, const Wrench& wrench);
  void command_level(const ControlSetpoint& setpoint, const AttitudeDemand& demand);

  // Changes of gains.
  void begin_gain_change(const Request& request, const Outcome& outcome);
  void begin_gain_changes(const ClientInputs& clients);
  void update_gains();

  // The outer loop for each control mode.
  AttitudeDemand follow_reference(bool integrate, double dt_s);
  AttitudeDemand spool_up(double lift_fraction, double dt_s);
  AttitudeDemand descend_level(double speed) const;
  AttitudeDemand follow_direct_setpoint(const ControlSetpoint& setpoint) const;

  // With learnt lift and ground effect: modelled lift (m/s^2) of the rotors now, over that of the vehicle file,
  // and the mass that the commanded thrust is to carry.
  double ground_effect_now() const;
  Eigen::Vector3d expected_disturbance() const;  // m/s^2, NED, to compensate
  double modelled_lift() const { return ground_effect_now() * rotors.thrust_n() / vehicle.mass_kg; }
  double lift_now() const { return lift.ratio() * modelled_lift(); }
  double carried_mass_kg() const { return vehicle.mass_kg / (lift.ratio() * ground_effect_now()); }
  // The thrust command leads the observed thrust, so that the thrust follows with this lag.
  double thrust_lead() const {
    return level == plant::ControlLevel::kActuators ? settings.rough_air.thrust_lead : 0.0;
  }
  double thrust_lag_s() const { return rotor_lag_s / (1.0 + thrust_lead()); }
  bool observes_lift_off() const { return settings.rough_air.learn_lift && controls_position(); }

  bool controls_position() const { return level != plant::ControlLevel::kTrajectory; }

  plant::Vehicle vehicle;
  ControlSettings settings;
  double rotor_lag_s;
  double max_tilt_tangent;
  Estimator estimator;
  OdometryMotion odometry_motion;
  EstimateSource estimate_source;
  bool brings_odometry = false;  // the vehicle, in place of IMU samples
  PosesAhead poses_ahead;
  ClientInputs no_clients;  // stays empty
  RotorObserver rotors;
  LiftObserver lift;
  std::int64_t lift_off_ns = 0;  // stamp of the lift-off; 0: not yet
  DisturbanceObserver disturbance;
  MomentObserver moment;  // of the incremental law
  TakeoffConsistencyMonitor takeoff_monitor;
  PositionController position;
  AttitudeController attitude;
  Allocator allocator;
  Supervisor supervisor;

  GainChange gain_change;
  ControlGains gains;              // in force
  bool gains_are_constant = true;  // and set in the control laws
  std::int64_t saturated_ns = -1;  // of the last saturated command; -1: none

  std::int64_t last_stamp_ns = 0;
  int unusable_samples = 0;            // in a row
  std::int64_t unusable_since_ns = 0;  // the last stamp before them, or the one after time went back
  double unusable_s = 0.0;
  std::uint32_t resets_seen = 0;  // resets of the estimate that the supervisor has processed
  double imu_gap_s = 0.0;         // between the last two usable samples
  Eigen::Vector3d specific_force_frd = Eigen::Vector3d::Zero();
  bool has_battery = false;
  std::int64_t battery_stamp_ns = 0;
  double supply_voltage_v;  // measured
  SupplyObserver supply_observer;
  Allocator::Supply supply;  // now
  VehicleFault vehicle_fault{};
  VehicleFault vehicle_refusal{};
  std::int64_t vehicle_fault_since_ns = 0;  // of the first step with it
  bool rotors_running = true;               // as the vehicle reports
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  plant::ControlLevels accepted_levels = plant::ControlLevel::kActuators;
  plant::ActuatorCommand command;  // at other levels without throttles
  double thrust_n = 0.0;           // collective thrust of the command, at other levels
  plant::ObeyedCommand obeyed;     // as the vehicle reports
  SentCommands sent_commands;
  plant::VehicleCommand sent;  // the command at the level
  Reference reference;
  math::Heading heading;  // of the reference's yaw
  AttitudeSetpoint attitude_setpoint;
  Status status;
};

}  // namespace swiftlet::control

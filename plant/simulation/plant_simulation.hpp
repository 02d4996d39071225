// The simulated vehicle: dynamics, air, floor and the sensors on board, advanced step by step. Deterministic:
// the same vehicle, settings, seed and commands give the same samples bit by bit. Time is a whole number of
// steps from the start and has no drift.
//
//   PlantSimulation plant(vehicle, settings, seed);
//   for (;;) {
//     if (plant.imu()) ... publish, wait for a command ...
//     plant.step(watchdog.drive(plant.stamp_ns()));
//   }
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "swiftlet/plant/model/samples.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/simulation/dynamics.hpp"
#include "swiftlet/plant/simulation/ground_contact.hpp"
#include "swiftlet/plant/simulation/imu.hpp"
#include "swiftlet/plant/simulation/links/faults.hpp"
#include "swiftlet/plant/simulation/settings.hpp"
#include "swiftlet/plant/simulation/vehicle_state.hpp"
#include "swiftlet/plant/simulation/wind_model.hpp"

namespace swiftlet::plant {

class PlantSimulation {
 public:
  // Vehicle and settings must be such that validate() finds no fault. Stands at rest at the origin, rotors
  // off, unless an initial state is given; the battery's part of it is that of the settings. Samples of stamp
  // 0 are there at once.
  PlantSimulation(const Vehicle& vehicle, const SimulationSettings& settings, std::uint64_t seed,
                  const VehicleState& initial = {});

  // One integration step with the drive held. Throttles must lie within 0 .. 1: ActuatorWatchdog sees to it.
  void step(const MotorCommand& drive);

  std::int64_t stamp_ns() const { return stamp_ns_; }
  const VehicleState& state() const { return state_; }
  TruthSample truth() const;
  // The stamp is one of the IMU's, whether a fault keeps the sample back or not; how many there have been.
  bool imu_due() const { return imu_due_; }
  std::uint64_t imu_count() const { return imu_schedule_.sequence; }
  // Samples that are sent at this stamp.
  const std::optional<ImuSample>& imu() const { return imu_sample_; }
  const std::optional<BatterySample>& battery() const { return battery_sample_; }
  const std::optional<RotorSpeedSample>& rotor_speeds() const { return rotor_speed_sample_; }

  bool on_ground() const { return on_ground_; }
  const Imu& imu_sensor() const { return imu_; }

 private:
  // Counts steps between samples.
  struct Schedule {
    std::int64_t steps_per_sample;  // 0: never
    std::int64_t steps_left = 0;
    std::uint64_t sequence = 0;

    bool due() {
      if (steps_per_sample == 0 || steps_left-- > 0) return false;
      steps_left = steps_per_sample - 1;
      ++sequence;
      return true;
    }
  };

  void change_faults();
  void sample(const MotorCommand& drive);
  void sample_imu();
  Eigen::Vector3d specific_force_frd();

  Dynamics dynamics_;
  GroundContact ground_;
  WindModel air_;
  Imu imu_;
  std::int64_t step_ns_;
  double step_s_;
  int rotor_count_;
  FaultSchedule faults_;
  std::int64_t fault_change_ns_;  // the next
  Eigen::Vector3d fault_wind_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d wind_ned_;  // of the step under way

  std::int64_t stamp_ns_ = 0;
  std::uint64_t steps_ = 0;
  VehicleState state_;
  bool on_ground_ = false;
  Eigen::Vector3d contact_sum_ned_ =
      Eigen::Vector3d::Zero();  // the floor's accelerations since the last IMU sample
  std::int64_t contact_steps_ = 0;

  Schedule imu_schedule_;
  Schedule battery_schedule_;
  Schedule rotor_speed_schedule_;
  bool imu_due_ = false;
  std::optional<ImuSample> imu_sample_;
  ImuSample last_sound_imu_;  // before the values got stuck
  std::optional<BatterySample> battery_sample_;
  std::optional<RotorSpeedSample> rotor_speed_sample_;
};

}  // namespace swiftlet::plant

// The simulated vehicle: dynamics, wind, ground contact and on-board sensors, advanced step by step. It is
// deterministic: the same vehicle, settings, seed and commands give bit-identical samples. Time is a whole
// number of steps since the start and does not drift.
//
//   PlantSimulation plant(vehicle, settings, seed);
//   for (;;) {
//     if (plant.imu()) ... publish, wait for a command ...
//     plant.step(watchdog.motor_command(plant.stamp_ns()));
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
  // Precondition: validate() finds no violation in vehicle and settings. By default the vehicle is at rest at
  // the origin with its rotors off. The battery state of `initial` is ignored; the settings give it. The
  // samples of stamp 0 are available after construction.
  PlantSimulation(const Vehicle& vehicle, const SimulationSettings& settings, std::uint64_t seed,
                  const VehicleState& initial = {});

  // Advances by one integration step with a constant motor command. Throttles must lie within 0 .. 1;
  // CommandWatchdog ensures that.
  void step(const MotorCommand& drive);

  std::int64_t stamp_ns() const { return stamp_ns_; }
  const VehicleState& state() const { return state_; }
  TruthSample truth() const;
  // imu_due(): true if an IMU sample is due at this stamp, even if a fault suppresses it. imu_count(): number
  // of samples due so far.
  bool imu_due() const { return imu_due_; }
  std::uint64_t imu_count() const { return imu_schedule_.sequence; }
  // Samples sent at this stamp; empty if none is due or a fault suppresses it.
  const std::optional<ImuSample>& imu() const { return imu_sample_; }
  const std::optional<BatterySample>& battery() const { return samples_.battery; }
  const std::optional<RotorSpeedSample>& rotor_speeds() const { return samples_.rotor_speeds; }
  const SensorSamples& samples() const { return samples_; }

  bool on_ground() const { return on_ground_; }
  const Imu& imu_sensor() const { return imu_; }

 private:
  // Counts the steps between samples.
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
  std::int64_t fault_change_ns_;  // next stamp at which a fault starts or ends
  Eigen::Vector3d fault_wind_ned_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d wind_ned_;  // m/s, over the current step

  std::int64_t stamp_ns_ = 0;
  std::uint64_t steps_ = 0;
  VehicleState state_;
  bool on_ground_ = false;
  Eigen::Vector3d contact_sum_ned_ =
      Eigen::Vector3d::Zero();  // m/s^2, sum of contact accelerations since the last IMU sample
  std::int64_t contact_steps_ = 0;

  Schedule imu_schedule_;
  Schedule battery_schedule_;
  Schedule rotor_speed_schedule_;
  bool imu_due_ = false;
  std::optional<ImuSample> imu_sample_;
  ImuSample last_sound_imu_;  // last sample before kImuStuck
  SensorSamples samples_;
};

}  // namespace swiftlet::plant

// Reinforcement learning: a simulated vehicle that starts in the air near a target and is to hover there. The vehicle,
// its firmware and its sensors are those of ClosedLoop; the actions take the place of the flight controller.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "swiftlet/math/random.hpp"
#include "swiftlet/plant/model/control_level.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/plant/model/violation.hpp"
#include "swiftlet/plant/simulation/firmware/firmware.hpp"
#include "swiftlet/plant/simulation/links/command_path.hpp"
#include "swiftlet/plant/simulation/links/mocap_path.hpp"
#include "swiftlet/plant/simulation/mocap.hpp"
#include "swiftlet/plant/simulation/plant_simulation.hpp"
#include "swiftlet/simulation/dispersion.hpp"

namespace swiftlet::simulation {

struct HoverTask {
  // At which the actions command the vehicle:
  //   actuators   throttle of each rotor, delta of Eq. (8), 0 .. 1
  //   rates       body rates p, q, r (rad/s, FRD), thrust over mass (m/s^2, along -z of FRD)
  //   attitude    roll, pitch, yaw (rad, Eq. (3)), thrust over mass (m/s^2)
  //   trajectory  velocity (m/s, NED), yaw rate (rad/s)
  plant::ControlLevel level = plant::ControlLevel::kActuators;
  double action_period_s = 0.02;               // a whole number of integration steps, at most command_hold_s
  double episode_s = 10.0;                     // an episode is truncated after this time
  Eigen::Vector3d target_ned{0.0, 0.0, -1.5};  // m
  double radius_m = 1.0;                       // an episode ends further away from the target
  double start_distance_m = 0.5;               // the start is uniform in this ball about the target
  double start_speed_m_s = 0.5;                // likewise the velocity
  double start_tilt_rad = 0.2;                 // likewise the rotation from level, heading north
  double start_rate_rad_s = 0.5;               // likewise the body rates
  // Bounds of the actions.
  double max_rate_rad_s = 6.0;
  double max_tilt_rad = 0.6;
  double max_speed_m_s = 2.0;
  double max_yaw_rate_rad_s = 1.5;
};

// Returns the rules that the task violates. Keys are the names of its members.
std::vector<plant::Violation> validate(const HoverTask& task, const World& nominal);

// Lower and upper bound of each component of an action, as HoverTask::level has them. The greatest thrust over mass is
// that of the nominal vehicle with a full battery.
struct ActionBounds {
  std::vector<double> low, high;
};
ActionBounds action_bounds(const HoverTask& task, const plant::Vehicle& vehicle);

// One vehicle. Deterministic: the same seed and actions give bit-identical results.
class HoverEnvironment {
 public:
  // Size of an observation without the rotors, and with them.
  static constexpr int kRigidBody = 18;
  static int observation_size(const plant::Vehicle& vehicle) { return kRigidBody + vehicle.rotor_count(); }

  struct Outcome {
    double reward = 0.0;
    bool terminated = false;  // it left the radius, tipped over or touched the ground
    bool truncated = false;   // the time of the episode is over
  };

  // dispersion: from which the vehicle and the simulation of each episode are drawn; may be empty. Call reset() before
  // step(). Throws std::invalid_argument with a sentence if the task breaks a rule.
  HoverEnvironment(const World& nominal, const HoverTask& task, const Dispersion& dispersion);

  // Begins the first episode of a seed.
  void reset(std::uint64_t seed);
  // Begins the next episode of the seed. Throws as draw() does.
  void reset();

  // Flies for action_period_s. action: of action_bounds().low.size() numbers; those beyond a bound are clipped.
  // Precondition: all are finite, and the episode has not ended.
  //
  // The reward is action_period_s * (1 - distance / radius_m - 0.02 * body rate / (rad/s)): an episode gives at most
  // episode_s. It is 0 for the step in which the episode terminates.
  Outcome step(const double* action);

  // The ground truth: target minus position (m, NED), velocity (m/s, NED), rotation matrix from FRD to NED row by row,
  // body rates (rad/s, FRD), and the speed of each rotor over that of hover.
  void observe(double* observation) const;

  const ActionBounds& bounds() const { return bounds_; }
  const plant::PlantSimulation& plant() const { return flight_->plant; }

 private:
  // What each episode builds anew.
  struct Flight {
    Flight(const World& world, std::uint64_t seed, const plant::VehicleState& initial);

    plant::PlantSimulation plant;
    plant::Mocap mocap;
    plant::MocapPath mocap_path;
    plant::CommandPath command_path;
    plant::Firmware firmware;
    std::int64_t imu_stamp_ns = 0;
    std::uint64_t imu_sequence = 0;
    std::uint64_t commands = 0;
  };

  plant::VehicleState initial_state(std::uint64_t seed, const plant::Vehicle& vehicle) const;
  plant::VehicleCommand command_of(const double* action);
  void send(plant::VehicleCommand command);
  void collect();

  World nominal_;
  HoverTask task_;
  Dispersion dispersion_;
  ActionBounds bounds_;
  int steps_per_action_;
  int actions_per_episode_;
  double hover_speed_;  // rad/s, of the nominal vehicle

  math::RandomStream episodes_;
  std::optional<Flight> flight_;
  double mass_kg_ = 0.0;  // of the nominal vehicle, by which the firmware knows it
  double yaw_rad_ = 0.0;  // commanded, at level trajectory
  int actions_ = 0;       // of this episode
};

}  // namespace swiftlet::simulation

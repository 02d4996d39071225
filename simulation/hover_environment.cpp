#include "swiftlet/simulation/hover_environment.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "swiftlet/math/euler.hpp"
#include "swiftlet/math/time.hpp"
#include "swiftlet/plant/model/airframe.hpp"
#include "swiftlet/plant/model/battery.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/plant/simulation/streams.hpp"

namespace swiftlet::simulation {
namespace {

using plant::ControlLevel;
using Rows3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

constexpr double kRateCost = 0.02;         // s/rad, see HoverEnvironment::step()
constexpr double kLeastClearance_m = 0.1;  // of a start from the ground
constexpr double kLongestEpisode_s = 3600.0;

double greatest_specific_thrust(const plant::Vehicle& vehicle) {
  const double full_v = plant::open_circuit_voltage(vehicle.battery, 1.0);
  return vehicle.rotor_count() * plant::steady_thrust_range(vehicle, full_v).max / vehicle.mass_kg;
}

World checked(const World& nominal, const HoverTask& task) {
  for (const plant::Violation& violation : validate(task, nominal))
    throw std::invalid_argument(violation.key + " " + violation.message);
  return nominal;
}

World at_level(World world, ControlLevel level) {
  world.simulation.control_levels = level;
  world.simulation.odometry.source = plant::OdometrySource::kNone;
  return world;
}

Eigen::Quaterniond rotation(const Eigen::Vector3d& vector_rad) {
  const double angle = vector_rad.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector_rad / angle));
}

}  // namespace

std::vector<plant::Violation> validate(const HoverTask& task, const World& nominal) {
  std::vector<plant::Violation> violations = validate(nominal);
  for (plant::Violation& fault : plant::validate_faults(nominal.simulation.faults, nominal.vehicle))
    violations.push_back(std::move(fault));
  const plant::SimulationSettings& simulation = nominal.simulation;
  plant::RuleChecker check;
  if (check.between("action_period_s", task.action_period_s, 1e-9 * static_cast<double>(simulation.step_ns),
                    simulation.command_hold_s) &&
      math::nanoseconds(task.action_period_s) % simulation.step_ns != 0)
    check.add("action_period_s", "is ", task.action_period_s,
              ", must be a whole number of integration steps of ",
              1e-9 * static_cast<double>(simulation.step_ns), " s");
  check.between("episode_s", task.episode_s, task.action_period_s, kLongestEpisode_s);
  for (int axis = 0; axis < 3; ++axis) check.finite("target_ned", task.target_ned[axis]);
  check.above("radius_m", task.radius_m, 0.0);
  check.between("start_distance_m", task.start_distance_m, 0.0, task.radius_m);
  if (simulation.ground.present && !(-task.target_ned.z() - task.start_distance_m >= kLeastClearance_m))
    check.add("target_ned", "is ", -task.target_ned.z(), " m above the ground, must be at least ",
              kLeastClearance_m, " m more than start_distance_m, which is ", task.start_distance_m);
  check.between("start_speed_m_s", task.start_speed_m_s, 0.0, 100.0);
  check.between("start_tilt_rad", task.start_tilt_rad, 0.0, 0.5 * M_PI);
  check.between("start_rate_rad_s", task.start_rate_rad_s, 0.0, 100.0);
  check.above("max_rate_rad_s", task.max_rate_rad_s, 0.0);
  check.between("max_tilt_rad", task.max_tilt_rad, 0.0, 0.5 * M_PI);
  check.above("max_speed_m_s", task.max_speed_m_s, 0.0);
  check.above("max_yaw_rate_rad_s", task.max_yaw_rate_rad_s, 0.0);
  for (plant::Violation& own : check.take()) violations.push_back(std::move(own));
  return violations;
}

ActionBounds action_bounds(const HoverTask& task, const plant::Vehicle& vehicle) {
  const double thrust = greatest_specific_thrust(vehicle);
  const double rate = task.max_rate_rad_s;
  const double tilt = task.max_tilt_rad;
  const double speed = task.max_speed_m_s;
  const auto rotors = static_cast<std::size_t>(vehicle.rotor_count());
  switch (task.level) {
    case ControlLevel::kActuators:
      return {std::vector<double>(rotors, 0.0), std::vector<double>(rotors, 1.0)};
    case ControlLevel::kRates:
      return {{-rate, -rate, -rate, 0.0}, {rate, rate, rate, thrust}};
    case ControlLevel::kAttitude:
      return {{-tilt, -tilt, -M_PI, 0.0}, {tilt, tilt, M_PI, thrust}};
    case ControlLevel::kTrajectory:
      return {{-speed, -speed, -speed, -task.max_yaw_rate_rad_s},
              {speed, speed, speed, task.max_yaw_rate_rad_s}};
  }
  return {};
}

HoverEnvironment::Flight::Flight(const World& world, std::uint64_t seed, const plant::VehicleState& initial)
    : plant(world.vehicle, world.simulation, seed, initial),
      mocap(world.simulation.mocap, seed),
      mocap_path(world.simulation, seed),
      command_path(world.simulation, seed),
      firmware(world.vehicle, world.simulation) {}

HoverEnvironment::HoverEnvironment(const World& nominal, const HoverTask& task, const Dispersion& dispersion)
    : nominal_(at_level(checked(nominal, task), task.level)),
      task_(task),
      dispersion_(dispersion),
      bounds_(action_bounds(task, nominal.vehicle)),
      steps_per_action_(
          static_cast<int>(math::nanoseconds(task.action_period_s) / nominal.simulation.step_ns)),
      actions_per_episode_(static_cast<int>(std::ceil(task.episode_s / task.action_period_s - 1e-9))),
      hover_speed_(plant::hover_speed(nominal.vehicle)),
      episodes_(0, 0),
      mass_kg_(nominal.vehicle.mass_kg) {}

void HoverEnvironment::reset(std::uint64_t seed) {
  episodes_ = math::RandomStream(seed, plant::streams::of_name("environment.episodes"));
  reset();
}

void HoverEnvironment::reset() {
  const std::uint64_t seed = episodes_.next();
  const World world = dispersion_.distributions.empty() ? nominal_ : draw(dispersion_, nominal_, seed).world;
  const plant::VehicleState initial = initial_state(seed, world.vehicle);
  flight_.emplace(world, seed, initial);
  actions_ = 0;
  yaw_rad_ = 0.0;
  // The vehicle has flown before: its estimator knows its pose.
  plant::PoseSample pose;
  pose.tracked = true;
  pose.position_ned = initial.position_ned;
  pose.q_ned_from_frd = initial.q_ned_from_frd;
  flight_->firmware.on_pose(pose);
  collect();
}

plant::VehicleState HoverEnvironment::initial_state(std::uint64_t seed, const plant::Vehicle& vehicle) const {
  math::RandomStream random(seed, plant::streams::of_name("environment.start"));
  plant::VehicleState state;
  state.position_ned = task_.target_ned + task_.start_distance_m * random.in_unit_ball();
  state.velocity_ned = task_.start_speed_m_s * random.in_unit_ball();
  state.q_ned_from_frd = rotation(task_.start_tilt_rad * random.in_unit_ball());
  state.body_rates_frd = task_.start_rate_rad_s * random.in_unit_ball();
  for (std::size_t i = 0; i < vehicle.rotors.size(); ++i) state.rotor_speeds[i] = plant::hover_speed(vehicle);
  return state;
}

plant::VehicleCommand HoverEnvironment::command_of(const double* action) {
  const auto value = [&](std::size_t i) { return std::clamp(action[i], bounds_.low[i], bounds_.high[i]); };
  const auto vector = [&] { return Eigen::Vector3d(value(0), value(1), value(2)); };
  switch (task_.level) {
    case ControlLevel::kActuators: {
      plant::ActuatorCommand command;
      command.rotor_count = nominal_.vehicle.rotor_count();
      for (std::size_t i = 0; i < bounds_.low.size(); ++i) command.throttle[i] = value(i);
      return command;
    }
    case ControlLevel::kRates: {
      plant::RatesSetpoint command;
      command.body_rates_frd = vector();
      command.thrust_n = mass_kg_ * value(3);
      return command;
    }
    case ControlLevel::kAttitude: {
      plant::AttitudeSetpoint command;
      command.q_ned_from_frd = math::quaternion_from_euler(vector());
      command.thrust_n = mass_kg_ * value(3);
      return command;
    }
    case ControlLevel::kTrajectory: {
      plant::TrajectorySetpoint command;
      command.velocity_ned = vector();
      command.yaw_rate = value(3);
      yaw_rad_ = math::wrap_angle(yaw_rad_ + task_.action_period_s * command.yaw_rate);
      command.yaw_rad = yaw_rad_;
      return command;
    }
  }
  return {};
}

void HoverEnvironment::send(plant::VehicleCommand command) {
  plant::CommandHeader& header = plant::header_of(command);
  header.stamp_ns = flight_->imu_stamp_ns;
  header.sequence = ++flight_->commands;
  header.imu_sequence = flight_->imu_sequence;
  header.rotor_state = plant::RotorState::kRunning;
  const std::int64_t now_ns = flight_->plant.stamp_ns();
  if (flight_->command_path.send(command, now_ns)) flight_->firmware.accept(command, now_ns);
}

// The samples of this stamp, as ClosedLoop gives them to the firmware.
void HoverEnvironment::collect() {
  const plant::PlantSimulation& plant = flight_->plant;
  if (plant.imu()) {
    flight_->imu_stamp_ns = plant.imu()->stamp_ns;
    flight_->imu_sequence = plant.imu()->sequence;
    flight_->firmware.on_imu(*plant.imu());
  }
  if (plant.battery()) flight_->firmware.on_battery(*plant.battery());
  if (!flight_->firmware.needs_poses()) return;
  const std::int64_t now_ns = plant.stamp_ns();
  const plant::VehicleState& truth = plant.state();
  if (const auto pose = flight_->mocap_path.pass(
          flight_->mocap.update(now_ns, truth.position_ned, truth.q_ned_from_frd), now_ns))
    flight_->firmware.on_pose(*pose);
}

HoverEnvironment::Outcome HoverEnvironment::step(const double* action) {
  send(command_of(action));
  for (int i = 0; i < steps_per_action_; ++i) {
    const std::int64_t now_ns = flight_->plant.stamp_ns();
    if (const auto arrived = flight_->command_path.arrived(now_ns))
      flight_->firmware.accept(*arrived, now_ns);
    flight_->plant.step(flight_->firmware.motor_command(now_ns));
    collect();
  }
  ++actions_;

  const plant::VehicleState& state = flight_->plant.state();
  const double distance_m = (task_.target_ned - state.position_ned).norm();
  const bool upright = (state.q_ned_from_frd * Eigen::Vector3d::UnitZ()).z() > 0.0;
  Outcome outcome;
  outcome.terminated = !(distance_m <= task_.radius_m) || !upright || flight_->plant.on_ground();
  outcome.truncated = !outcome.terminated && actions_ >= actions_per_episode_;
  if (!outcome.terminated)
    outcome.reward =
        task_.action_period_s * (1.0 - distance_m / task_.radius_m - kRateCost * state.body_rates_frd.norm());
  return outcome;
}

void HoverEnvironment::observe(double* observation) const {
  const plant::VehicleState& state = flight_->plant.state();
  Eigen::Map<Eigen::Vector3d>(observation + 0) = task_.target_ned - state.position_ned;
  Eigen::Map<Eigen::Vector3d>(observation + 3) = state.velocity_ned;
  Eigen::Map<Rows3>(observation + 6) = state.q_ned_from_frd.toRotationMatrix();
  Eigen::Map<Eigen::Vector3d>(observation + 15) = state.body_rates_frd;
  for (std::size_t i = 0; i < nominal_.vehicle.rotors.size(); ++i)
    observation[kRigidBody + i] = state.rotor_speeds[i] / hover_speed_;
}

}  // namespace swiftlet::simulation

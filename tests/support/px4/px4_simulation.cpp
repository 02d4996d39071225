#include "tests/support/px4/px4_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "tests/support/paths.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr int kStatusTicks = 50;
constexpr int kBatteryTicks = 10;
constexpr std::int64_t kVisionDelayNs = 15'000'000;  // EKF2_EV_DELAY
constexpr std::int64_t kPositionTimeoutNs = 1'000'000'000;
constexpr double kLandSpeed = 0.7;  // m/s
constexpr std::uint8_t kNavLand = 18, kNavDescend = 12;

plant::SimulationSettings simulation_settings() {
  plant::SimulationSettings settings =
      io::load_simulation_settings(in_source("config/simulation/default.yaml"));
  settings.control_levels = plant::ControlLevel::kRates;
  settings.control_levels.add(plant::ControlLevel::kAttitude);
  settings.control_levels.add(plant::ControlLevel::kTrajectory);
  return settings;
}

plant::VehicleState standing(double east_m) {
  plant::VehicleState state;
  state.position_ned.y() = east_m;
  return state;
}

std::array<float, 3> floats(const Vector3d& in) {
  return {static_cast<float>(in.x()), static_cast<float>(in.y()), static_cast<float>(in.z())};
}
Vector3d vector(const std::array<float, 3>& in) { return {in[0], in[1], in[2]}; }

// What is not given is 0.
Vector3d given(const std::array<float, 3>& in) {
  return vector(in).unaryExpr([](double value) { return std::isfinite(value) ? value : 0.0; });
}

plant::TrajectorySetpoint converted(const px4_msg::TrajectorySetpoint& in) {
  plant::TrajectorySetpoint out;
  out.position_used = vector(in.position()).allFinite();
  out.position_ned = given(in.position());
  out.velocity_ned = given(in.velocity());
  out.acceleration_ned = given(in.acceleration());
  out.yaw_rad = std::isfinite(in.yaw()) ? in.yaw() : 0.0;
  out.yaw_rate = std::isfinite(in.yawspeed()) ? in.yawspeed() : 0.0;
  return out;
}

}  // namespace

Px4Simulation::Px4Simulation(const plant::Vehicle& vehicle, double thrust_factor, double east_m)
    : vehicle_(vehicle),
      thrust_factor_(thrust_factor),
      simulation_settings_(simulation_settings()),
      simulation_(vehicle_, simulation_settings_, 1, standing(east_m)),
      firmware_(vehicle_, simulation_settings_) {}

void Px4Simulation::on_offboard_mode(const px4_msg::OffboardControlMode& mode) {
  rules_.on_offboard_mode(mode, now_us());
  last_mode_ = mode;
  ++offboard_modes_;
}

std::optional<px4_msg::VehicleCommandAck> Px4Simulation::on_command(const px4_msg::VehicleCommand& command) {
  commands_.push_back(command);
  return rules_.on_command(command, now_us());
}

void Px4Simulation::on_setpoint(const px4_msg::VehicleRatesSetpoint& message) {
  plant::RatesSetpoint setpoint;
  setpoint.body_rates_frd = {message.roll(), message.pitch(), message.yaw()};
  setpoint.thrust_n = thrust_n(message.thrust_body());
  take(setpoint);
}

void Px4Simulation::on_setpoint(const px4_msg::VehicleAttitudeSetpoint& message) {
  plant::AttitudeSetpoint setpoint;
  const std::array<float, 4>& q = message.q_d();
  setpoint.q_ned_from_frd = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  setpoint.body_rates_frd = {0.0, 0.0, message.yaw_sp_move_rate()};
  setpoint.thrust_n = thrust_n(message.thrust_body());
  take(setpoint);
}

void Px4Simulation::on_setpoint(const px4_msg::TrajectorySetpoint& message) { take(converted(message)); }

void Px4Simulation::on_pose(const px4_msg::VehicleOdometry& message) {
  plant::PoseSample pose;
  pose.tracked = true;
  pose.position_ned = vector(message.position());
  const std::array<float, 4>& q = message.q();
  pose.q_ned_from_frd = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
  pose.stamp_ns = std::max<std::int64_t>(simulation_.stamp_ns() - kVisionDelayNs, 0);
  firmware_.on_pose(pose);
  pose_ns_ = simulation_.stamp_ns();
  last_pose_ = message;
  ++poses_;
}

double Px4Simulation::thrust_n(const std::array<float, 3>& thrust_body) const {
  const double throttle = std::clamp<double>(-thrust_body[2], 0.0, 1.0);
  if (throttle == 0.0) return 0.0;
  return thrust_factor_ * vehicle_.rotor_count() *
         plant::steady_thrust_from_throttle(vehicle_, voltage_v_, throttle);
}

void Px4Simulation::take(plant::VehicleCommand setpoint) {
  setpoint_ = std::move(setpoint);
  ++setpoints_;
}

// PX4's own modes: lands, or stays where it is.
plant::TrajectorySetpoint Px4Simulation::own_setpoint() const {
  plant::TrajectorySetpoint setpoint = own_;
  const bool lands = own_mode_ == kNavLand || own_mode_ == kNavDescend;
  if (!lands) return setpoint;
  setpoint.position_used = false;
  setpoint.velocity_ned = {0.0, 0.0, kLandSpeed};
  return setpoint;
}

plant::VehicleCommand Px4Simulation::command() const {
  plant::VehicleCommand command = rules_.offboard() ? setpoint_ : own_setpoint();
  if (!rules_.armed() || plant::level_of(command) == plant::ControlLevel::kActuators)
    command = plant::rotors_off(plant::ControlLevel::kTrajectory, {}, vehicle_.rotor_count());
  plant::CommandHeader& header = plant::header_of(command);
  header = {};
  header.stamp_ns = simulation_.stamp_ns();
  header.rotor_state = rules_.armed() ? plant::RotorState::kRunning : plant::RotorState::kOff;
  return command;
}

void Px4Simulation::step() {
  const std::uint8_t mode = rules_.status().nav_state();
  if (mode != own_mode_) {
    own_mode_ = mode;
    own_ = {};
    own_.position_used = true;
    own_.position_ned = simulation_.state().position_ned;
  }
  const std::int64_t end_ns = simulation_.stamp_ns() + kPeriodNs;
  while (simulation_.stamp_ns() < end_ns) {
    if (simulation_.imu()) firmware_.on_imu(*simulation_.imu());
    if (simulation_.battery()) {
      voltage_v_ = simulation_.battery()->voltage_v;
      firmware_.on_battery(*simulation_.battery());
    }
    firmware_.accept(command(), simulation_.stamp_ns());
    simulation_.step(firmware_.motor_command(simulation_.stamp_ns()));
  }
  Px4Rules::Motion motion;
  motion.touches_ground = simulation_.on_ground();
  motion.has_position = pose_ns_ >= 0 && simulation_.stamp_ns() - pose_ns_ < kPositionTimeoutNs;
  rules_.update(motion, now_us());
}

Px4Messages Px4Simulation::advance(std::uint64_t stamp_us) {
  step();
  return messages(stamp_us);
}

Px4Messages Px4Simulation::messages(std::uint64_t stamp_us) {
  ++ticks_;
  Px4Messages out;
  if (const std::optional<plant::ImuSample> imu = simulation_.imu()) {
    px4_msg::SensorCombined& sensors = out.sensors.emplace();
    sensors.timestamp(stamp_us);
    sensors.accelerometer_m_s2(floats(imu->specific_force_frd));
    sensors.gyro_rad(floats(imu->body_rates_frd));
  }
  const plant::OnboardEstimator& estimator = firmware_.estimator();
  out.odometry.pose_frame(1);
  out.odometry.position(floats(estimator.position_ned()));
  const Quaterniond q = estimator.q_ned_from_frd();
  out.odometry.q({static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
                  static_cast<float>(q.z())});
  out.odometry.velocity_frame(1);
  out.odometry.velocity(floats(estimator.velocity_ned()));
  out.odometry.angular_velocity(floats(estimator.body_rates_frd()));
  // As PX4's does, it is published some time after the sample that it is of.
  out.odometry.timestamp_sample(stamp_us);
  out.odometry.timestamp(stamp_us + (ticks_ % 2 == 0 ? kLatePublicationUs : 0));
  if (ticks_ % kBatteryTicks == 0) {
    px4_msg::BatteryStatus& battery = out.battery.emplace();
    battery.timestamp(stamp_us);
    battery.connected(true);
    battery.voltage_v(static_cast<float>(voltage_v_));
    battery.current_a(1.0F);
    battery.remaining(0.9F);
  }
  out.status = rules_.status();
  out.land_detected = rules_.land_detected();
  out.flags = rules_.flags();
  out.status.timestamp(stamp_us);
  out.land_detected.timestamp(stamp_us);
  out.flags.timestamp(stamp_us);
  const bool changed = out.status.nav_state() != published_.nav_state() ||
                       out.status.arming_state() != published_.arming_state();
  published_ = out.status;
  out.has_status = changed || ticks_ % kStatusTicks == 0;
  return out;
}

}  // namespace swiftlet::tests

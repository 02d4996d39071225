#include "tests/support/px4/scripted_px4.hpp"

#include <algorithm>
#include <cmath>

#include "swiftlet/io/settings/simulation_file.hpp"
#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::tests {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr std::uint64_t kLatePublicationUs = 5'000;
constexpr std::int64_t kPeriodNs = 10'000'000;
constexpr int kStatusTicks = 50;
constexpr int kBatteryTicks = 10;
constexpr std::int64_t kVisionDelayNs = 15'000'000;  // EKF2_EV_DELAY
constexpr std::int64_t kPositionTimeoutNs = 1'000'000'000;
constexpr double kLandSpeed = 0.7;  // m/s
constexpr std::uint8_t kLand = 18, kDescend = 12;

plant::SimulationSettings simulation_settings() {
  plant::SimulationSettings settings =
      runtime::load_simulation_settings(SWIFTLET_SOURCE_DIR "/config/simulation/default.yaml");
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

ScriptedPx4::ScriptedPx4(const plant::Vehicle& vehicle, const comms::NodeSettings& network,
                         const ScriptedPx4Settings& settings)
    : vehicle_(vehicle),
      settings_(settings),
      simulation_settings_(simulation_settings()),
      topics_(settings.instance),
      status_topic_(topics_.folder, settings.status_topic),
      simulation_(vehicle_, simulation_settings_, 1, standing(settings.east_m)),
      firmware_(vehicle_, simulation_settings_),
      node_(network),
      sensors_(node_.publish(topics_.sensors.get())),
      odometry_(node_.publish(topics_.odometry.get())),
      battery_(node_.publish(topics_.battery.get())),
      status_(node_.publish(status_topic_.get())),
      land_detected_(node_.publish(topics_.land_detected.get())),
      flags_(node_.publish(topics_.failsafe_flags.get())),
      acks_(node_.publish(topics_.command_ack.get())),
      truth_(node_.publish(comms::topics::kGroundTruth)) {
  subscribe();
  thread_ = std::thread([this] { run(); });
}

ScriptedPx4::~ScriptedPx4() {
  stop_ = true;
  thread_.join();
  subscriptions_.clear();
}

std::uint64_t ScriptedPx4::stamp_us() const {
  return static_cast<std::uint64_t>(runtime::system_ns() / 1000 - settings_.stamps_lag_us);
}

void ScriptedPx4::subscribe() {
  subscriptions_.push_back(node_.subscribe<px4_msg::OffboardControlMode>(
      topics_.offboard_control_mode.get(), [this](const auto& message) {
        if (!receives) return;
        const std::lock_guard<std::mutex> lock(mutex_);
        rules_.on_offboard_mode(message, simulation_.stamp_ns() / 1000);
        last_mode_ = message;
        ++offboard_modes_;
      }));
  subscriptions_.push_back(
      node_.subscribe<px4_msg::VehicleCommand>(topics_.command.get(), [this](const auto& message) {
        if (!receives) return;
        std::optional<px4_msg::VehicleCommandAck> ack;
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          commands_.push_back(message);
          ack = rules_.on_command(message, simulation_.stamp_ns() / 1000);
        }
        if (!ack || !sends) return;
        ack->timestamp(stamp_us());
        acks_.publish(*ack);
      }));
  subscriptions_.push_back(node_.subscribe<px4_msg::VehicleRatesSetpoint>(
      topics_.rates_setpoint.get(), [this](const auto& message) {
        plant::RatesSetpoint setpoint;
        setpoint.body_rates_frd = {message.roll(), message.pitch(), message.yaw()};
        setpoint.thrust_n = thrust_n(message.thrust_body());
        take(setpoint);
      }));
  subscriptions_.push_back(node_.subscribe<px4_msg::VehicleAttitudeSetpoint>(
      topics_.attitude_setpoint.get(), [this](const auto& message) {
        plant::AttitudeSetpoint setpoint;
        const std::array<float, 4>& q = message.q_d();
        setpoint.q_ned_from_frd = Quaterniond(q[0], q[1], q[2], q[3]).normalized();
        setpoint.body_rates_frd = {0.0, 0.0, message.yaw_sp_move_rate()};
        setpoint.thrust_n = thrust_n(message.thrust_body());
        take(setpoint);
      }));
  subscriptions_.push_back(node_.subscribe<px4_msg::TrajectorySetpoint>(
      topics_.trajectory_setpoint.get(), [this](const auto& message) {
        take(converted(message));
        const std::lock_guard<std::mutex> lock(mutex_);
        last_trajectory_ = message;
      }));
  subscriptions_.push_back(
      node_.subscribe<px4_msg::VehicleOdometry>(topics_.visual_odometry.get(), [this](const auto& message) {
        if (!receives) return;
        const std::lock_guard<std::mutex> lock(mutex_);
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
      }));
}

double ScriptedPx4::thrust_n(const std::array<float, 3>& thrust_body) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const double throttle = std::clamp<double>(-thrust_body[2], 0.0, 1.0);
  if (throttle == 0.0) return 0.0;
  return settings_.thrust_factor * vehicle_.rotor_count() *
         plant::steady_thrust_from_throttle(vehicle_, voltage_v_, throttle);
}

void ScriptedPx4::take(plant::VehicleCommand setpoint) {
  if (!receives) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  setpoint_ = std::move(setpoint);
  ++setpoints_;
}

void ScriptedPx4::run() {
  runtime::PeriodicTimer timer(kPeriodNs, 10 * kPeriodNs);
  while (!stop_) {
    timer.wait();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      advance();
    }
    publish();
  }
}

// PX4's own modes: lands, or stays where it is.
plant::TrajectorySetpoint ScriptedPx4::own_setpoint() const {
  plant::TrajectorySetpoint setpoint = own_;
  const bool lands = own_mode_ == kLand || own_mode_ == kDescend;
  if (!lands) return setpoint;
  setpoint.position_used = false;
  setpoint.velocity_ned = {0.0, 0.0, kLandSpeed};
  return setpoint;
}

plant::VehicleCommand ScriptedPx4::command() const {
  plant::VehicleCommand command = rules_.offboard() ? setpoint_ : own_setpoint();
  if (!rules_.armed() || plant::level_of(command) == plant::ControlLevel::kActuators)
    command = plant::rotors_off(plant::ControlLevel::kTrajectory, {}, vehicle_.rotor_count());
  plant::CommandHeader& header = plant::header_of(command);
  header = {};
  header.stamp_ns = simulation_.stamp_ns();
  header.rotor_state = rules_.armed() ? plant::RotorState::kRunning : plant::RotorState::kOff;
  return command;
}

void ScriptedPx4::advance() {
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
  height_m_ = -simulation_.state().position_ned.z();
  Px4Rules::Motion motion;
  motion.touches_ground = simulation_.on_ground();
  motion.has_position = pose_ns_ >= 0 && simulation_.stamp_ns() - pose_ns_ < kPositionTimeoutNs;
  rules_.update(motion, simulation_.stamp_ns() / 1000);
}

void ScriptedPx4::publish() {
  std::unique_lock<std::mutex> lock(mutex_);
  plant::TruthSample truth = simulation_.truth();
  truth.sequence = static_cast<std::uint64_t>(++ticks_);
  truth.stamp_ns = runtime::monotonic_ns();
  px4_msg::SensorCombined sensors;
  const std::optional<plant::ImuSample> imu = simulation_.imu();
  if (imu) {
    sensors.accelerometer_m_s2(floats(imu->specific_force_frd));
    sensors.gyro_rad(floats(imu->body_rates_frd));
  }
  px4_msg::VehicleOdometry odometry;
  const plant::OnboardEstimator& estimator = firmware_.estimator();
  odometry.pose_frame(1);
  odometry.position(floats(estimator.position_ned()));
  const Quaterniond q = estimator.q_ned_from_frd();
  odometry.q({static_cast<float>(q.w()), static_cast<float>(q.x()), static_cast<float>(q.y()),
              static_cast<float>(q.z())});
  odometry.velocity_frame(1);
  odometry.velocity(floats(estimator.velocity_ned()));
  odometry.angular_velocity(floats(estimator.body_rates_frd()));
  const px4_msg::VehicleStatus status = rules_.status();
  const px4_msg::VehicleLandDetected land = rules_.land_detected();
  const px4_msg::FailsafeFlags flags = rules_.flags();
  px4_msg::BatteryStatus battery;
  battery.connected(true);
  battery.voltage_v(static_cast<float>(voltage_v_));
  battery.current_a(1.0F);
  battery.remaining(0.9F);
  const int tick = ticks_;
  const bool changed =
      status.nav_state() != published_.nav_state() || status.arming_state() != published_.arming_state();
  published_ = status;
  lock.unlock();

  truth_.publish(comms::to_message(truth));
  if (!sends) return;
  const auto send = [this](auto& publisher, auto message) {
    message.timestamp(stamp_us());
    publisher.publish(message);
  };
  if (imu) send(sensors_, sensors);
  // As PX4 does, it is published some time after the sample that it is of.
  odometry.timestamp_sample(stamp_us());
  odometry.timestamp(odometry.timestamp_sample() + (tick % 2 == 0 ? kLatePublicationUs : 0));
  odometry_.publish(odometry);
  if (tick % kBatteryTicks == 0) send(battery_, battery);
  if (!changed && tick % kStatusTicks != 0) return;
  send(flags_, flags);
  send(land_detected_, land);
  send(status_, status);
}

void ScriptedPx4::pilot_selects(std::uint8_t nav_state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rules_.pilot_selects(nav_state, simulation_.stamp_ns() / 1000);
}
void ScriptedPx4::kill() {
  const std::lock_guard<std::mutex> lock(mutex_);
  rules_.kill(simulation_.stamp_ns() / 1000);
}
void ScriptedPx4::refuse_to_arm(bool refuse) {
  const std::lock_guard<std::mutex> lock(mutex_);
  rules_.refuses_to_arm = refuse;
}
px4_msg::VehicleStatus ScriptedPx4::status() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return rules_.status();
}
std::vector<px4_msg::VehicleCommand> ScriptedPx4::commands() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return commands_;
}
std::optional<px4_msg::VehicleOdometry> ScriptedPx4::last_pose() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_pose_;
}
std::optional<px4_msg::OffboardControlMode> ScriptedPx4::last_mode() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_mode_;
}
std::optional<px4_msg::TrajectorySetpoint> ScriptedPx4::last_trajectory() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_trajectory_;
}

}  // namespace swiftlet::tests

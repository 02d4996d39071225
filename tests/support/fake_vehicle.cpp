#include "tests/support/fake_vehicle.hpp"

#include <algorithm>
#include <chrono>

#include "swiftlet/plant/model/propulsion.hpp"
#include "swiftlet/services/messages/wire_version.hpp"

namespace swiftlet::tests {
namespace {

constexpr double kPeriodS = static_cast<double>(FakeVehicle::kPeriodNs) * 1e-9;
constexpr double kBraking_s = 0.02;
constexpr std::uint64_t kImuPerFrame = 5;
constexpr std::uint64_t kImuPerBattery = 50;
constexpr std::uint64_t kImuPerInfo = 25;
constexpr std::chrono::milliseconds kPatience{200};  // for a control that has answered the sample before

}  // namespace

FakeVehicle::FakeVehicle(const plant::Vehicle& parameters, const dds::NodeSettings& network,
                         plant::ControlLevel level)
    : parameters_(parameters),
      level_(level),
      node_(network),
      imu_(node_.publish(messages::topics::kImu)),
      mocap_(node_.publish(messages::topics::kMocapPose)),
      battery_(node_.publish(messages::topics::kBattery)) {
  if (level_ == plant::ControlLevel::kAttitude) {
    info_ = node_.publish(messages::topics::kVehicleInfo);
    subscription_ = node_.subscribe<messages::msg::AttitudeSetpoint>(
        messages::topics::kAttitudeSetpoint, [this](const messages::msg::AttitudeSetpoint& setpoint) {
          const std::lock_guard lock(mutex_);
          if (setpoint.stamp_ns() <= started_ns_) return;  // for the vehicle before its restart
          attitude_ = setpoint;
          note_answer(setpoint.imu_sequence_number());
        });
  } else {
    subscription_ = node_.subscribe<messages::msg::ActuatorCommand>(
        messages::topics::kActuatorCommand, [this](const messages::msg::ActuatorCommand& command) {
          const std::lock_guard lock(mutex_);
          if (command.stamp_ns() <= started_ns_) return;
          commands_.push_back(command);
          note_answer(command.imu_sequence_number());
        });
  }
  thread_ = std::thread([this] { run(); });
}

FakeVehicle::~FakeVehicle() {
  stop_ = true;
  thread_.join();
}

std::vector<messages::msg::ActuatorCommand> FakeVehicle::commands() const {
  const std::lock_guard lock(mutex_);
  return commands_;
}

bool FakeVehicle::attitude_commanded() const {
  const std::lock_guard lock(mutex_);
  return attitude_.rotor_state() == messages::msg::ActuatorCommand_Constants::ROTORS_RUNNING;
}

std::optional<messages::msg::ActuatorCommand> FakeVehicle::last_command() const {
  const std::lock_guard lock(mutex_);
  return commands_.empty() ? std::nullopt : std::optional(commands_.back());
}

void FakeVehicle::run() {
  while (!stop_) {
    if (restarts_.exchange(false)) begin_again();
    move();
    publish();
    wait_for_answer();
  }
}

void FakeVehicle::restart() {
  restarts_ = true;
  while (restarts_) std::this_thread::yield();
}

void FakeVehicle::begin_again() {
  const std::lock_guard lock(mutex_);
  started_ns_ += static_cast<std::int64_t>(imu_sequence_) * kPeriodNs;
  imu_sequence_ = answered_ = 0;
  commands_.clear();
  attitude_ = {};
  up_speed_ = rotor_speed_ = 0.0;
  height_m_ = highest_m_ = fastest_rotor_ = 0.0;
}

void FakeVehicle::wait_for_answer() {
  std::unique_lock lock(mutex_);
  const std::chrono::nanoseconds patience =
      is_answered_ && sends_imu ? std::chrono::nanoseconds(kPatience) : std::chrono::nanoseconds(kPeriodNs);
  is_answered_ = answer_.wait_for(lock, patience, [this] { return answered_ >= imu_sequence_ || stop_; });
}

void FakeVehicle::note_answer(std::uint64_t imu_sequence) {
  answered_ = std::max(answered_, imu_sequence);
  answer_.notify_one();
}

// Vertical motion only; the floor is at height 0.
void FakeVehicle::move() {
  double wanted_speed = 0.0;
  double thrust_n = 0.0;
  {
    const std::lock_guard lock(mutex_);
    const bool running = !commands_.empty() && commands_.back().rotor_state() ==
                                                   messages::msg::ActuatorCommand_Constants::ROTORS_RUNNING;
    if (running)
      wanted_speed = plant::steady_speed_from_throttle(parameters_, kSupplyV, commands_.back().throttle()[0]);
    if (attitude_.rotor_state() == messages::msg::ActuatorCommand_Constants::ROTORS_RUNNING)
      thrust_n = attitude_.thrust_n();
  }
  rotor_speed_ += (wanted_speed - rotor_speed_) * kPeriodS / parameters_.motor.time_constant_s;
  fastest_rotor_ = std::max(fastest_rotor_.load(), rotor_speed_);
  const double lift =
      thrust_n + parameters_.rotor_count() * plant::thrust_from_speed(parameters_.rotor, rotor_speed_);
  up_acceleration_ = lift / parameters_.mass_kg - plant::kGravity;
  // The floor brakes the vehicle with a time constant of 20 ms, which its accelerometer measures.
  if (height_m_ <= 0.0) up_acceleration_ = std::max(up_acceleration_, -up_speed_ / kBraking_s);
  up_speed_ += up_acceleration_ * kPeriodS;
  height_m_ = std::max(height_m_ + up_speed_ * kPeriodS, 0.0);
  highest_m_ = std::max(highest_m_.load(), height_m_.load());
}

void FakeVehicle::publish() {
  const std::uint64_t sequence = ++imu_sequence_;
  const std::int64_t stamp_ns = started_ns_ + static_cast<std::int64_t>(sequence) * kPeriodNs;
  if (seen_by_mocap && sequence % kImuPerFrame == 0) {
    messages::msg::MocapPose pose;
    pose.stamp_ns(stamp_ns);
    pose.sequence_number(++mocap_sequence_);
    pose.tracked(tracked);
    pose.position_ned({0.0, 0.0, -height_m_});
    pose.q_ned_from_frd({1.0, 0.0, 0.0, 0.0});
    mocap_.publish(pose);
  }
  if (sequence % kImuPerBattery == 1) {
    messages::msg::Battery battery;
    battery.stamp_ns(stamp_ns);
    battery.sequence_number(++battery_sequence_);
    battery.voltage_v(kSupplyV);
    battery.state_of_charge(0.8);
    battery_.publish(battery);
  }
  messages::msg::Imu imu;
  imu.stamp_ns(stamp_ns);
  imu.sequence_number(sequence);
  imu.specific_force_frd({0.0, 0.0, -(up_acceleration_ + plant::kGravity)});
  if (sends_imu) imu_.publish(imu);
  if (level_ == plant::ControlLevel::kAttitude && sequence % kImuPerInfo == 0) publish_info();
}

void FakeVehicle::publish_info() {
  messages::msg::VehicleInfo info;
  info.wire_version(messages::kWireVersion);
  info.stamp_ns(started_ns_ + static_cast<std::int64_t>(samples()) * kPeriodNs);
  info.sequence_number(samples() / kImuPerInfo);
  info.name() = parameters_.name;
  info.rotor_count(static_cast<std::uint8_t>(parameters_.rotor_count()));
  info.mass_kg(parameters_.mass_kg);
  info.imu_rate_hz(1e9 / static_cast<double>(kPeriodNs));
  info.rotors_running(reports_rotors && attitude_commanded());
  info.control_levels(messages::msg::VehicleInfo_Constants::LEVEL_ATTITUDE);
  info_.publish(info);
}

}  // namespace swiftlet::tests

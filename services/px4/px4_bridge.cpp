#include "swiftlet/services/px4/px4_bridge.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>
#include <spdlog/spdlog.h>

#include "swiftlet/services/dds/discovery/peer_log.hpp"
#include "swiftlet/services/px4/words.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::px4 {
namespace {

namespace topics = comms::topics;

constexpr std::int64_t kPeriodNs = 10'000'000;
constexpr std::int64_t kInfoPeriodNs = 1'000'000'000;
constexpr std::int64_t kSearchPeriodNs = 500'000'000;
constexpr std::int64_t kBatteryPeriodNs = 100'000'000;
constexpr std::int64_t kStreamGapNs = 400'000'000;  // PX4 wants a proof of life twice a second
constexpr std::int64_t kCommandTimeoutNs = 500'000'000;
constexpr std::int64_t kPoseTimeoutNs = 500'000'000;
constexpr double kImuRateHz = 100.0;  // PX4's client sends no topic more often
// Before arming: PX4's estimate against motion capture.
constexpr double kGreatestDistance_m = 0.3;
constexpr double kGreatestAngle_rad = 0.35;

std::int64_t ns(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

OffboardSettings offboard_settings(const BridgeSettings& settings) {
  OffboardSettings offboard;
  offboard.control_silence_ns = ns(settings.control_silence_s);
  return offboard;
}

}  // namespace

Px4Bridge::Px4Bridge(const comms::Participant& participant, const std::string& name,
                     const BridgeSettings& settings)
    : HostedVehicle(name),
      settings_(settings),
      topics_(settings.instance),
      session_(offboard_settings(settings)),
      watchdog_(settings.vehicle.rotor_count(), kCommandTimeoutNs, settings.levels),
      scale_(settings.vehicle, settings.hover_throttle),
      vision_(settings.vision),
      participant_(participant),
      node_(participant, name, [this](const std::string& fault) { fail(fault); }),
      battery_(node_.publish(topics::kBattery)),
      vehicle_info_(node_.publish(topics::kVehicleInfo)),
      modes_(node_.publish(topics_.offboard_control_mode.get())),
      rates_(node_.publish(topics_.rates_setpoint.get())),
      attitudes_(node_.publish(topics_.attitude_setpoint.get())),
      trajectories_(node_.publish(topics_.trajectory_setpoint.get())),
      poses_(node_.publish(topics_.visual_odometry.get())),
      commands_(node_.publish(topics_.command.get())),
      clock_server_(node_, [] { return runtime::monotonic_ns(); }) {
  if (settings.samples == Samples::kImu) {
    imu_ = node_.publish(topics::kImu);
  } else {
    vehicle_odometry_ = node_.publish(topics::kVehicleOdometry);
  }
  info_.name() = settings.vehicle.name;
  info_.rotor_count(static_cast<std::uint8_t>(settings.vehicle.rotor_count()));
  info_.mass_kg(settings.vehicle.mass_kg);
  info_.imu_rate_hz(kImuRateHz);
  info_.control_levels(settings.levels.bits());
  comms::log_peers(node_);
  subscribe();
}

void Px4Bridge::subscribe() {
  using comms::Delivery;
  const auto add = [this](comms::Subscription subscription) {
    subscriptions_.push_back(std::move(subscription));
  };
  add(node_.subscribe<msg::BatteryStatus>(topics_.battery.get(),
                                          [this](const auto& message) { on_battery(message); }));
  add(node_.subscribe<msg::VehicleStatus>(topics_.status.get(),
                                          [this](const auto& message) { on_status(message); }));
  add(node_.subscribe<msg::FailsafeFlags>(topics_.failsafe_flags.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    flags_ = message;
  }));
  add(node_.subscribe<msg::VehicleLandDetected>(topics_.land_detected.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    landed_ = message.landed() || message.ground_contact();
  }));
  add(node_.subscribe<msg::VehicleCommandAck>(topics_.command_ack.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    session_.on_ack(message);
  }));
  add(node_.subscribe<comms::msg::MocapPose>(
      topics::kMocapPose, [this](const auto& message) { on_pose(message); }, Delivery::kOwnThread,
      comms::kSourceSilence));
  // Control sends at one level at a time.
  if (settings_.levels.has(plant::ControlLevel::kRates))
    add(node_.subscribe<comms::msg::RatesSetpoint>(
        topics::kRatesSetpoint,
        [this](const auto& message) {
          on_setpoint<comms::msg::RatesSetpoint, plant::RatesSetpoint>(message);
        },
        Delivery::kOwnThread));
  if (settings_.levels.has(plant::ControlLevel::kAttitude))
    add(node_.subscribe<comms::msg::AttitudeSetpoint>(
        topics::kAttitudeSetpoint,
        [this](const auto& message) {
          on_setpoint<comms::msg::AttitudeSetpoint, plant::AttitudeSetpoint>(message);
        },
        Delivery::kOwnThread));
  if (settings_.levels.has(plant::ControlLevel::kTrajectory))
    add(node_.subscribe<comms::msg::TrajectorySetpoint>(
        topics::kTrajectorySetpoint,
        [this](const auto& message) {
          on_setpoint<comms::msg::TrajectorySetpoint, plant::TrajectorySetpoint>(message);
        },
        Delivery::kOwnThread));
  add(node_.subscribe<msg::VehicleOdometry>(
      topics_.odometry.get(), [this](const auto& message) { on_odometry(message); }, Delivery::kOwnThread));
  add(node_.subscribe<msg::SensorCombined>(
      topics_.sensors.get(), [this](const auto& message) { on_sensors(message); }, Delivery::kOwnThread));
}

void Px4Bridge::on_sensors(const msg::SensorCombined& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  sensor_thread_.enter(settings_.realtime);
  plant::ImuSample sample;
  const comms::Fault fault = from_px4(message, sample);
  if (fault) return sensor_faults_.note(fault);
  plant::ObeyedCommand obeyed;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (version_.state == VersionState::kUnknown) return;
    const bool flies = session_.phase() == Phase::kFlying && !landed_;
    if (thrust_n_ > 0.0 || !flies) scale_.learn(thrust_n_, -sample.specific_force_frd.z(), flies, now_ns);
    if (settings_.samples != Samples::kImu) return;
    sampled_ns_ = now_ns;
    sample.stamp_ns = clock_.to_host(message.timestamp(), now_ns);
    sample.sequence = ++samples_;
    obeyed = watchdog_.obeyed();
  }
  comms::msg::Imu out = comms::to_message(sample);
  comms::set_obeyed_command(obeyed, out);
  imu_.publish(out);
}

void Px4Bridge::on_odometry(const msg::VehicleOdometry& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (settings_.samples == Samples::kOdometry) odometry_thread_.enter(settings_.realtime);
  comms::msg::VehicleOdometry out;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    const comms::Fault fault = from_px4(message, estimate_);
    if (fault) return odometry_faults_.note(fault);
    if (estimate_.position_valid) estimated_ns_ = now_ns;
    if (settings_.samples != Samples::kOdometry || version_.state == VersionState::kUnknown) return;
    sampled_ns_ = now_ns;
    // Of the IMU sample that it was propagated to; message.timestamp() is when it was published.
    estimate_.stamp_ns = clock_.to_host(message.timestamp_sample(), now_ns);
    estimate_.sequence = ++samples_;
    estimate_.fuses_mocap = vision_.passed() > 0;
    out = comms::to_message(estimate_);
    comms::set_obeyed_command(watchdog_.obeyed(), out);
  }
  vehicle_odometry_.publish(out);
}

void Px4Bridge::on_battery(const msg::BatteryStatus& message) {
  plant::BatterySample sample;
  const comms::Fault fault = from_px4(message, sample);
  if (fault) return battery_faults_.note(fault);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    scale_.set_voltage(sample.voltage_v);
    sample.stamp_ns = runtime::monotonic_ns();
    if (sample.stamp_ns - battery_ns_ < kBatteryPeriodNs) return;
    battery_ns_ = sample.stamp_ns;
    sample.sequence = ++battery_samples_;
  }
  battery_.publish(comms::to_message(sample));
}

void Px4Bridge::on_status(const msg::VehicleStatus& message) {
  const comms::Fault fault = check(message);
  if (fault) return status_faults_.note(fault);
  const std::lock_guard<std::mutex> lock(mutex_);
  status_ = message;
  status_ns_ = runtime::monotonic_ns();
}

template <class Message, class Command>
void Px4Bridge::on_setpoint(const Message& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  command_thread_.enter(settings_.realtime);
  Command command;
  if (comms::from_message(message, command)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  const plant::CommandFault fault = watchdog_.accept(command, now_ns);
  if (fault != plant::CommandFault::kNone) {
    ++refused_commands_;
    refusal_ = fault;
    return;
  }
  if (commanded_ns_ == 0 || now_ns - commanded_ns_ > kStreamGapNs || !session_.streams())
    streamed_since_ns_ = now_ns;
  commanded_ns_ = now_ns;
  rotors_wanted_ = command.rotor_state == plant::RotorState::kRunning;
  level_ = plant::level_of(command);
  if (session_.streams()) stream(command);
}

// PX4 obeys setpoints in other modes than offboard, too: while rotors are off it gets the proof of life alone.
void Px4Bridge::stream(const plant::VehicleCommand& command) {
  ++setpoints_;
  thrust_n_ = rotors_wanted_ ? thrust_of(command).value_or(0.0) : 0.0;
  modes_.publish(offboard_mode(command));
  if (!rotors_wanted_) return;
  if (const auto* rates = std::get_if<plant::RatesSetpoint>(&command)) rates_.publish(to_px4(*rates, scale_));
  if (const auto* attitude = std::get_if<plant::AttitudeSetpoint>(&command))
    attitudes_.publish(to_px4(*attitude, scale_));
  if (const auto* trajectory = std::get_if<plant::TrajectorySetpoint>(&command))
    trajectories_.publish(to_px4(*trajectory));
}

void Px4Bridge::on_pose(const comms::msg::MocapPose& message) {
  pose_thread_.enter(settings_.realtime);
  plant::PoseSample pose;
  if (message.sequence_number() == 0 || comms::from_message(message, pose)) return;
  const std::int64_t now_ns = runtime::monotonic_ns();
  std::optional<msg::VehicleOdometry> odometry;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (version_.state == VersionState::kUnknown) return;
    odometry = vision_.take(pose, now_ns, runtime::system_ns() - now_ns);
  }
  if (odometry) poses_.publish(*odometry);
}

std::string Px4Bridge::arming_fault(std::int64_t now_ns) const {
  const bool uses_estimate =
      level_ == plant::ControlLevel::kAttitude || level_ == plant::ControlLevel::kTrajectory;
  if (!uses_estimate) return {};
  if (estimated_ns_ == 0 || now_ns - estimated_ns_ > kPoseTimeoutNs)
    return "PX4 must not be armed: it publishes no vehicle_odometry";
  // Control commands in the frame of PX4's estimate then, and knows whether motion capture is needed.
  if (settings_.samples == Samples::kOdometry) return {};
  const std::optional<plant::PoseSample>& pose = vision_.last();
  if (!pose || now_ns - pose->stamp_ns > kPoseTimeoutNs)
    return "PX4 must not be armed: no pose of motion capture";
  const double distance_m = (estimate_.position_ned - pose->position_ned).norm();
  if (distance_m > kGreatestDistance_m)
    return fmt::format(
        "PX4 must not be armed: its position is {:.1f} m from that of motion capture, limit {:g} m",
        distance_m, kGreatestDistance_m);
  const double angle_rad = estimate_.q_ned_from_frd.angularDistance(pose->q_ned_from_frd);
  if (angle_rad > kGreatestAngle_rad)
    return fmt::format(
        "PX4 must not be armed: its attitude is {:.1f} rad from that of motion capture, limit {:g} rad",
        angle_rad, kGreatestAngle_rad);
  return {};
}

OffboardInputs Px4Bridge::inputs(std::int64_t now_ns) const {
  OffboardInputs inputs;
  inputs.now_ns = now_ns;
  inputs.rotors_wanted = rotors_wanted_;
  inputs.commanded_ns = commanded_ns_;
  inputs.streamed_since_ns = streamed_since_ns_;
  inputs.status = status_;
  inputs.status_ns = status_ns_;
  inputs.sampled_ns = sampled_ns_;
  inputs.flags = flags_;
  inputs.version_fault = version_.fault;
  inputs.arming_fault = arming_fault(now_ns);
  return inputs;
}

void Px4Bridge::run(const std::atomic<bool>& stop) {
  if (settings_.realtime.enabled) runtime::make_this_thread_realtime(settings_.realtime);
  runtime::PeriodicTimer timer(kPeriodNs, kPeriodNs);
  while (!stop.load(std::memory_order_relaxed)) {
    timer.wait();
    std::optional<msg::VehicleCommand> command;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      command = session_.update(inputs(runtime::monotonic_ns()));
    }
    if (command) commands_.publish(*command);
  }
}

void Px4Bridge::attend() {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (now_ns >= search_due_ns_) {
    search_due_ns_ = now_ns + kSearchPeriodNs;
    Version version = version_of(participant_.topics_seen(), topics_.folder);
    const std::lock_guard<std::mutex> lock(mutex_);
    // Topics vanish from discovery while a link is down: what was found stays known.
    if (version.state != VersionState::kNoTopics) version_ = std::move(version);
  }
  const comms::msg::VehicleInfo before = info_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    info_.rotors_running(session_.rotors_running());
    info_.fault() = fmt::format("{:.127}", session_.fault());
  }
  log_changes();
  const bool changed = info_.rotors_running() != before.rotors_running() || info_.fault() != before.fault();
  if (!changed && now_ns < info_due_ns_) return;
  info_due_ns_ = now_ns + kInfoPeriodNs;
  info_.stamp_ns(now_ns);
  info_.sequence_number(info_.sequence_number() + 1);
  vehicle_info_.publish(info_);
}

void Px4Bridge::log_changes() {
  Phase phase{};
  std::string fault;
  std::uint64_t refused = 0;
  plant::CommandFault refusal{};
  int steps = 0;
  double hover = 0.0;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    phase = session_.phase();
    fault = session_.fault();
    refused = refused_commands_;
    refusal = refusal_;
    steps = clock_.steps();
    hover = scale_.hover_throttle();
  }
  if (phase != logged_phase_) spdlog::info("PX4: {}", to_string(phase));
  if (phase != logged_phase_ && phase == Phase::kDisarmed && logged_phase_ == Phase::kDisarming)
    spdlog::info("throttle of hover {:.3f}", hover);
  if (fault != logged_fault_ && !fault.empty()) spdlog::error(fault);
  if (steps != logged_steps_)
    spdlog::warn("PX4's stamps were set, {} times in all: its time synchronisation with the agent", steps);
  if (refused > logged_refused_ && phase == Phase::kFlying && logged_phase_ == Phase::kFlying)
    spdlog::warn("refused {} commands, the last: {}", refused - logged_refused_, plant::to_string(refusal));
  logged_phase_ = phase;
  logged_fault_ = fault;
  logged_refused_ = refused;
  logged_steps_ = steps;
}

void Px4Bridge::log_end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  spdlog::info(
      "ended: {} samples, {} setpoints, {} commands refused, {} poses to PX4, {} resets, throttle of "
      "hover {:.3f}",
      samples_, setpoints_, refused_commands_, vision_.passed(), vision_.resets(), scale_.hover_throttle());
}

}  // namespace swiftlet::px4

#include "swiftlet/services/px4/px4_bridge.hpp"

#include <optional>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/vehicle_info.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::px4 {
namespace {

namespace topics = messages::topics;

constexpr std::int64_t kPeriodNs = 10'000'000;
constexpr std::int64_t kInfoPeriodNs = 1'000'000'000;
constexpr std::int64_t kSearchPeriodNs = 500'000'000;
constexpr double kImuRateHz = 100.0;  // PX4's client sends no topic more often
}  // namespace

Px4Bridge::Px4Bridge(const dds::Participant& participant, const std::string& name,
                     const BridgeSettings& settings)
    : HostedVehicle(name),
      settings_(settings),
      topics_(settings.instance, settings.namespace_prefix),
      vehicle_(settings),
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
  messages::describe(settings.vehicle, info_);
  info_.boot(settings.boot);
  info_.imu_rate_hz(kImuRateHz);
  info_.control_levels(settings.levels.bits());
  dds::log_peers(node_);
  subscribe();
}

void Px4Bridge::subscribe() {
  using dds::Delivery;
  const auto add = [this](dds::Subscription subscription) {
    subscriptions_.push_back(std::move(subscription));
  };
  add(node_.subscribe<msg::BatteryStatus>(topics_.battery.get(),
                                          [this](const auto& message) { on_battery(message); }));
  add(node_.subscribe<msg::VehicleStatus>(topics_.status.get(),
                                          [this](const auto& message) { on_status(message); }));
  add(node_.subscribe<msg::FailsafeFlags>(topics_.failsafe_flags.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    vehicle_.on_flags(message);
  }));
  add(node_.subscribe<msg::VehicleLandDetected>(topics_.land_detected.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    vehicle_.on_land_detected(message);
  }));
  add(node_.subscribe<msg::VehicleCommandAck>(topics_.command_ack.get(), [this](const auto& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    vehicle_.on_ack(message);
  }));
  add(node_.subscribe<messages::msg::MocapPose>(
      topics::kMocapPose, [this](const auto& message) { on_pose(message); }, Delivery::kSensors,
      dds::OneSource{dds::kSourceSilence}));
  // Control sends at one level at a time.
  if (settings_.levels.has(plant::ControlLevel::kRates))
    add(node_.subscribe<messages::msg::RatesSetpoint>(
        topics::kRatesSetpoint,
        [this](const auto& message) {
          on_setpoint<messages::msg::RatesSetpoint, plant::RatesSetpoint>(message);
        },
        Delivery::kSamples));
  if (settings_.levels.has(plant::ControlLevel::kAttitude))
    add(node_.subscribe<messages::msg::AttitudeSetpoint>(
        topics::kAttitudeSetpoint,
        [this](const auto& message) {
          on_setpoint<messages::msg::AttitudeSetpoint, plant::AttitudeSetpoint>(message);
        },
        Delivery::kSamples));
  if (settings_.levels.has(plant::ControlLevel::kTrajectory))
    add(node_.subscribe<messages::msg::TrajectorySetpoint>(
        topics::kTrajectorySetpoint,
        [this](const auto& message) {
          on_setpoint<messages::msg::TrajectorySetpoint, plant::TrajectorySetpoint>(message);
        },
        Delivery::kSamples));
  add(node_.subscribe<msg::VehicleOdometry>(
      topics_.odometry.get(), [this](const auto& message) { on_odometry(message); }, Delivery::kSamples));
  add(node_.subscribe<msg::SensorCombined>(
      topics_.sensors.get(), [this](const auto& message) { on_sensors(message); }, Delivery::kSamples));
}

void Px4Bridge::on_sensors(const msg::SensorCombined& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  sensor_thread_.enter(settings_.realtime);
  messages::Fault fault;
  std::optional<messages::msg::Imu> imu;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    imu = vehicle_.on_sensors(message, now_ns, fault);
  }
  if (fault) sensor_faults_.note(fault);
  if (imu) imu_.publish(*imu);
}

void Px4Bridge::on_odometry(const msg::VehicleOdometry& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (settings_.samples == Samples::kOdometry) odometry_thread_.enter(settings_.realtime);
  messages::Fault fault;
  std::optional<messages::msg::VehicleOdometry> odometry;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    odometry = vehicle_.on_odometry(message, now_ns, fault);
  }
  if (fault) odometry_faults_.note(fault);
  if (odometry) vehicle_odometry_.publish(*odometry);
}

void Px4Bridge::on_battery(const msg::BatteryStatus& message) {
  messages::Fault fault;
  std::optional<messages::msg::Battery> battery;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    battery = vehicle_.on_battery(message, runtime::monotonic_ns(), fault);
  }
  if (fault) battery_faults_.note(fault);
  if (battery) battery_.publish(*battery);
}

void Px4Bridge::on_status(const msg::VehicleStatus& message) {
  const messages::Fault fault = check(message);
  if (fault) return status_faults_.note(fault);
  const std::lock_guard<std::mutex> lock(mutex_);
  vehicle_.on_status(message, runtime::monotonic_ns());
}

template <class Message, class Command>
void Px4Bridge::on_setpoint(const Message& message) {
  const std::int64_t now_ns = runtime::monotonic_ns();
  command_thread_.enter(settings_.realtime);
  Command command;
  if (messages::from_message(message, command)) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (const auto stream = vehicle_.on_command(command, now_ns)) publish(*stream);
}

void Px4Bridge::publish(const OffboardStream& stream) {
  modes_.publish(stream.mode);
  if (const auto* rates = std::get_if<msg::VehicleRatesSetpoint>(&stream.setpoint)) rates_.publish(*rates);
  if (const auto* attitude = std::get_if<msg::VehicleAttitudeSetpoint>(&stream.setpoint))
    attitudes_.publish(*attitude);
  if (const auto* trajectory = std::get_if<msg::TrajectorySetpoint>(&stream.setpoint))
    trajectories_.publish(*trajectory);
}

void Px4Bridge::on_pose(const messages::msg::MocapPose& message) {
  pose_thread_.enter(settings_.realtime);
  plant::PoseSample pose;
  if (message.sequence_number() == 0 || messages::from_message(message, pose)) return;
  const std::int64_t now_ns = runtime::monotonic_ns();
  std::optional<msg::VehicleOdometry> odometry;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    odometry = vehicle_.on_pose(pose, now_ns, runtime::system_ns() - now_ns);
  }
  if (odometry) poses_.publish(*odometry);
}

void Px4Bridge::run(const std::atomic<bool>& stop) {
  if (settings_.realtime.enabled) runtime::make_this_thread_realtime(settings_.realtime);
  runtime::PeriodicTimer timer(kPeriodNs, kPeriodNs);
  while (!stop.load(std::memory_order_relaxed)) {
    timer.wait();
    std::optional<msg::VehicleCommand> command;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      command = vehicle_.update(runtime::monotonic_ns());
    }
    if (command) commands_.publish(*command);
    pulse_.beat();
  }
}

void Px4Bridge::attend() {
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (now_ns >= search_due_ns_) {
    search_due_ns_ = now_ns + kSearchPeriodNs;
    Version version = version_of(participant_.topics_seen(), topics_.folder);
    const std::lock_guard<std::mutex> lock(mutex_);
    // Topics vanish from discovery while a link is down: what was found stays known.
    if (version.state != VersionState::kNoTopics) vehicle_.set_version(std::move(version));
  }
  const messages::msg::VehicleInfo before = info_;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    info_.rotors_running(vehicle_.session().rotors_running());
    info_.fault() = fmt::format("{:.127}", vehicle_.session().fault());
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
    phase = vehicle_.session().phase();
    fault = vehicle_.session().fault();
    refused = vehicle_.refused_commands();
    refusal = vehicle_.refusal();
    steps = vehicle_.stamp_steps();
    hover = vehicle_.hover_throttle();
  }
  if (phase != logged_phase_) runtime::log_info("PX4: {}", to_string(phase));
  if (phase != logged_phase_ && phase == Phase::kDisarmed && logged_phase_ == Phase::kDisarming)
    runtime::log_info("throttle of hover {:.3f}", hover);
  if (fault != logged_fault_ && !fault.empty()) runtime::log_error("{}", fault);
  if (steps != logged_steps_)
    runtime::log_warning("PX4's stamps were set, {} times in all: its time synchronisation with the agent",
                         steps);
  if (refused > logged_refused_ && phase == Phase::kFlying && logged_phase_ == Phase::kFlying)
    runtime::log_warning("refused {} commands, the last: {}", refused - logged_refused_,
                         plant::to_string(refusal));
  logged_phase_ = phase;
  logged_fault_ = fault;
  logged_refused_ = refused;
  logged_steps_ = steps;
}

void Px4Bridge::log_end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  runtime::log_info(
      "ended: {} samples, {} setpoints, {} commands refused, {} poses to PX4, {} resets, throttle of "
      "hover {:.3f}",
      vehicle_.samples(), vehicle_.setpoints(), vehicle_.refused_commands(), vehicle_.vision().passed(),
      vehicle_.vision().resets(), vehicle_.hover_throttle());
}

}  // namespace swiftlet::px4

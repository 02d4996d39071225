#include "swiftlet/services/control/control_service.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "swiftlet/control/design/battery_limits.hpp"
#include "swiftlet/services/control/failover.hpp"
#include "swiftlet/services/control/lockstep_driver.hpp"
#include "swiftlet/services/control/realtime_driver.hpp"
#include "swiftlet/services/messages/vehicle_info.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::services {
namespace {

namespace msg = messages::msg;
namespace topics = messages::topics;
using dds::Delivery;
using namespace std::chrono_literals;

constexpr std::int64_t kConditionsPeriodNs = 100'000'000;  // as control_status

// Without an IMU sample for this long, the vehicle's clock is not used: it may have stopped.
constexpr double kVehicleClockStands_s = 0.5;

// The battery is sampled at 10 Hz only. Well below battery_timeout_s, so that a restarted vehicle is heard in time.
constexpr auto kBatterySourceSilence = 1000ms;
constexpr auto kInfoSourceSilence = 2500ms;  // of vehicle_info, which comes once a second

}  // namespace

ControlService::ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                               int failover_priority, dds::Node& node,
                               const runtime::RealtimeSettings& realtime, runtime::Clock clock,
                               std::vector<control::FixedSetting> fixed,
                               std::optional<plant::ControlLevel> level)
    : controller_(runtime::random_id()),
      clock_(clock),
      loop_(vehicle, settings),
      command_server_(loop_, vehicle, settings, GainDesigner(vehicle, settings, std::move(fixed)), wake_),
      telemetry_(loop_, command_server_, control::with_battery_limits(settings.failsafe, vehicle), node,
                 controller_, control::observed_rotors(vehicle.motor.time_constant_s, settings)),
      commands_(node, vehicle.rotor_count()),
      rotor_count_(vehicle.rotor_count()),
      wanted_level_(level),
      expected_vehicle_(vehicle),
      max_vehicle_difference_(settings.arming.max_vehicle_difference),
      answers_(loop_, commands_, wake_, node, controller_, failover_priority, rotor_count_) {
  if (clock == runtime::Clock::kLockstep) {
    const std::uint32_t term = Failover(controller_, failover_priority).next_term();
    driver_ = std::make_unique<LockstepDriver>(term, answers_, wake_);
  } else {
    driver_ = std::make_unique<RealtimeDriver>(controller_, failover_priority, loop_, command_server_,
                                               answers_, wake_, node, realtime);
    telemetry_.watch_imu();
  }
  loop_.levels.put({plant::ControlLevel::kActuators, wanted_level_});
  subscribe(node);
}

void ControlService::subscribe_sensors(dds::Node& node) {
  using Inputs = plant::LockstepInputs;
  // In real time no other topic may delay IMU and poses. In lockstep threads of their own only cost wake-ups.
  const Delivery delivery = clock_ == runtime::Clock::kLockstep ? Delivery::kShared : Delivery::kSensors;
  sensors_.push_back({"poses", node.subscribe<msg::MocapPose>(
                                   topics::kMocapPose,
                                   [this](const auto& message) {
                                     // 0: a heartbeat of motion capture in lockstep, which is no pose
                                     if (message.sequence_number() == 0) return;
                                     note(pose_arrivals_, message);
                                     deliver(message, &Inputs::mocap_pose, loop_.pose, pose_faults_);
                                   },
                                   delivery, dds::OneSource{dds::kSourceSilence})});
  sensors_.push_back({"battery samples", node.subscribe<msg::Battery>(
                                             topics::kBattery,
                                             [this](const auto& message) {
                                               note(battery_arrivals_, message);
                                               deliver(message, &Inputs::battery, loop_.battery,
                                                       battery_faults_);
                                             },
                                             Delivery::kShared, dds::OneSource{kBatterySourceSilence})});
  // Rotor speeds can be as many as IMU samples. In the shared thread they would hold up the requests.
  sensors_.push_back({"rotor speeds", node.subscribe<msg::RotorSpeeds>(
                                          topics::kRotorSpeeds,
                                          [this](const auto& message) {
                                            deliver(message, &Inputs::rotor_speeds, loop_.rotor_speeds,
                                                    rotor_speed_faults_);
                                          },
                                          delivery, dds::OneSource{dds::kSourceSilence})});
}

void ControlService::subscribe(dds::Node& node) {
  subscribe_sensors(node);
  subscriptions_.push_back(node.subscribe<msg::VehicleInfo>(
      topics::kVehicleInfo, [this](const auto& message) { on_vehicle_info(message); }, Delivery::kShared,
      dds::OneSource{kInfoSourceSilence}));
  subscriptions_.push_back(node.subscribe<msg::Setpoint>(
      topics::kSetpoint, [this](const auto& message) { put(message, loop_.setpoint, setpoint_faults_); }));
  subscriptions_.push_back(node.subscribe<msg::GroundLink>(
      topics::kGroundLink, [this](const auto& message) { on_ground_link(message); }));
  subscriptions_.push_back(node.subscribe<msg::Command>(
      topics::kCommand, [this](const auto& message) { command_server_.on_command(message); }));
  subscriptions_.push_back(node.subscribe<msg::Mission>(
      topics::kMission, deliver_to_worker(&CommandServer::on_mission), Delivery::kPlans));
  subscriptions_.push_back(node.subscribe<msg::Trajectory>(
      topics::kTrajectory, deliver_to_worker(&CommandServer::on_trajectory), Delivery::kPlans));
  subscriptions_.push_back(node.subscribe<msg::ControlSettings>(
      topics::kControlSettings, deliver_to_worker(&CommandServer::on_control_settings), Delivery::kPlans));
  if (clock_ == runtime::Clock::kRealtime) {
    subscriptions_.push_back(node.subscribe<msg::Mission>(
        topics::kFlownMission, deliver_to_worker(&CommandServer::on_flown_mission), Delivery::kPlans));
    subscriptions_.push_back(node.subscribe<msg::Trajectory>(
        topics::kFlownTrajectory, deliver_to_worker(&CommandServer::on_flown_trajectory), Delivery::kPlans));
  }
  subscribe_motion(node, topics::kVehicleOdometry, "vehicle_odometry samples",
                   AnsweredSamples::Kind::kOdometry);
  subscribe_motion(node, topics::kImu, "IMU samples", AnsweredSamples::Kind::kImu);
}

// The samples that are answered: of the IMU, or the vehicle's own estimates in place of them.
template <class Message>
void ControlService::subscribe_motion(dds::Node& node, const messages::Topic<Message>& topic,
                                      const char* samples, AnsweredSamples::Kind kind) {
  const auto take = [this, kind](const Message& message) {
    const bool of_another_process = std::exchange(of_another_process_, false);
    const std::int64_t now_ns = runtime::monotonic_ns();
    if (!answered_samples_.admit(kind, now_ns)) return;
    note(imu_arrivals_, message);
    VehicleSample sample = vehicle_sample(message);
    sample.of_another_process = of_another_process;
    step_began_ns_.store(now_ns, std::memory_order_relaxed);
    driver_->on_sample(sample);
    step_began_ns_.store(kNoStep, std::memory_order_relaxed);
  };
  const Delivery delivery = clock_ == runtime::Clock::kLockstep ? Delivery::kShared : Delivery::kSamples;
  const dds::OneSource source{dds::kSourceSilence, [this] { of_another_process_ = true; }};
  sensors_.push_back({samples, node.subscribe<Message>(topic, take, delivery, source)});
}

template <class Message>
void ControlService::note(Arrivals& arrivals, const Message& message) {
  arrivals.note(message.stamp_ns(), message.sequence_number(), runtime::monotonic_ns());
}

template <class Message, class Sample>
void ControlService::put(const Message& message, runtime::LatestValue<Sample>& latest,
                         dds::ThrottledWarning& faults) {
  Sample sample;
  const messages::Fault fault = messages::from_message(message, sample);
  if (fault) return faults.note(fault);
  latest.put(sample);
}

template <class Message, class Sample>
void ControlService::deliver(const Message& message, StepDriver::Stream stream,
                             runtime::LatestValue<Sample>& latest, dds::ThrottledWarning& faults) {
  const auto put_message = [&] { put(message, latest, faults); };
  driver_->on_sensor(stream, message.sequence_number(), std::ref(put_message));  // std::ref: no allocation
}

template <class Message>
std::function<void(const Message&)> ControlService::deliver_to_worker(
    void (CommandServer::*take)(const Message&)) {
  return [this, take](const Message& message) {
    worker_.post([this, take, message] { (command_server_.*take)(message); });
  };
}

// A heartbeat that finds the queue full is lost; the tool repeats it.
void ControlService::on_ground_link(const msg::GroundLink& message) {
  control::GroundHeartbeat heartbeat;
  const messages::Fault fault = messages::from_message(message, heartbeat);
  if (fault) return ground_link_faults_.note(fault);
  loop_.ground_heartbeats.push(heartbeat);
}

void ControlService::run(const std::atomic<bool>& stop) {
  std::int64_t conditions_due_ns = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    adopt_levels();
    driver_->attend();
    const StreamAges ages = stream_ages();
    publish_pending_stop(ages);
    telemetry_.set_ages(ages);
    const std::int64_t now_ns = runtime::monotonic_ns();
    if (now_ns - step_began_ns_.load(std::memory_order_relaxed) < runtime::Pulse::kStillNs) pulse_.beat();
    if (now_ns >= conditions_due_ns) {
      telemetry_.set_conditions(driver_->is_realtime(), source_conflict());
      conditions_due_ns = now_ns + kConditionsPeriodNs;
    }
    telemetry_.publish_due();
    wake_.wait_for(50ms);
  }
}

void ControlService::on_vehicle_info(const msg::VehicleInfo& message) {
  const std::string foreign = messages::fault_of_wire_version(message.wire_version(), "the vehicle");
  // Known: this is another process's message.
  if (!foreign.empty() && reported_levels_.load(std::memory_order_relaxed) != 0) return;
  refuse_vehicle(foreign.empty() ? messages::difference(message, expected_vehicle_, max_vehicle_difference_)
                                 : foreign);
  if (!foreign.empty()) return driver_->levels_known();
  answers_.restarts().note_boot(message.boot());
  const std::uint8_t levels = plant::ControlLevels::from_bits(message.control_levels()).bits();
  if (reported_levels_.exchange(levels, std::memory_order_relaxed) != levels) wake_.post();
  control::VehicleFault fault{};
  const std::size_t length = std::min(message.fault().size(), fault.size() - 1);
  std::copy_n(message.fault().c_str(), length, fault.begin());
  loop_.vehicle_fault.put(fault);
  // In lockstep a simulated vehicle obeys at once, and this message comes at no certain sample.
  if (clock_ != runtime::Clock::kLockstep)
    loop_.vehicle_rotors_running.store(message.rotors_running(), std::memory_order_relaxed);
  telemetry_.set_vehicle_fault(fault.data());
}

// The vehicle cannot be armed until a vehicle_info without such a fault comes; a flight goes on. In lockstep its samples are
// answered, so that requests are. why: empty: it may be armed.
void ControlService::refuse_vehicle(const std::string& why) {
  if (why == vehicle_refusal_) return;
  vehicle_refusal_ = why;
  if (!why.empty()) runtime::log_error("{}: it cannot be armed", why);
  control::VehicleFault refusal{};
  std::copy_n(why.c_str(), std::min(why.size(), refusal.size() - 1), refusal.begin());
  loop_.vehicle_refusal.put(refusal);
}

// Opens the topic of the level before the inner loop commands at it.
void ControlService::adopt_levels() {
  const std::uint8_t reported = reported_levels_.load(std::memory_order_relaxed);
  if (reported == adopted_levels_) return;
  adopted_levels_ = reported;
  const auto levels = plant::ControlLevels::from_bits(reported);
  const plant::ControlLevel level = wanted_level_.value_or(levels.lowest());
  if (levels.has(level)) {
    commands_.open(level);
  } else {
    runtime::log_warning(
        "the vehicle does not accept commands at level {}, it accepts {}: it cannot be armed",
        plant::to_string(level), levels.names().data());
  }
  loop_.levels.put({levels, wanted_level_});
  driver_->levels_known();
}

// A stop request that no IMU sample lets the inner loop evaluate: commands rotors off until one does. In
// lockstep, time stands while samples that arrive wait for others: they are evaluated later.
void ControlService::publish_pending_stop(const StreamAges& ages) {
  const bool waits = clock_ == runtime::Clock::kLockstep && ages.imu_s >= 0.0 && ages.imu_s < kImuSilence_s;
  std::optional<control::RequestKey> stop;
  if (!waits) stop = command_server_.accept_overdue_stop(ages.imu_s, imu_arrivals_.stamp_ns());
  telemetry_.set_unconfirmed_stop(stop);
  if (!stop) return;
  plant::CommandHeader header;
  header.stamp_ns = imu_arrivals_.stamp_ns();
  header.sequence = imu_arrivals_.sequence();
  header.imu_sequence = imu_arrivals_.sequence();
  header.term = driver_->command_term();
  commands_.publish(plant::rotors_off(loop_.level(), header, rotor_count_));
}

StreamAges ControlService::stream_ages() const {
  const std::int64_t now_ns = runtime::monotonic_ns();
  StreamAges ages;
  ages.imu_s = imu_arrivals_.age_s(now_ns);
  std::optional<std::int64_t> vehicle_now_ns;
  if (ages.imu_s >= 0.0 && ages.imu_s < kVehicleClockStands_s) vehicle_now_ns = imu_arrivals_.stamp_ns();
  ages.pose_s = pose_arrivals_.age_s(now_ns, vehicle_now_ns);
  ages.battery_s = battery_arrivals_.age_s(now_ns, vehicle_now_ns);
  return ages;
}

// A sentence; empty if each topic has one source. The IMU, subscribed last, comes first.
std::string ControlService::source_conflict() const {
  for (auto sensor = sensors_.rbegin(); sensor != sensors_.rend(); ++sensor) {
    const auto conflict = sensor->subscription.source_conflict();
    if (!conflict) continue;
    return std::string(sensor->samples) + " of " + conflict->ignored.to_string() + " are ignored: those of " +
           conflict->used.to_string() + " are used";
  }
  if (const char* const ignored = answered_samples_.ignored(runtime::monotonic_ns()))
    return std::string(ignored) + " is ignored: the vehicle brings both imu and vehicle_odometry";
  return {};
}

}  // namespace swiftlet::services

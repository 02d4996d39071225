#include "swiftlet/services/control/control_service.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

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

// Without IMU samples and without an active controller for this long, requests are answered: they are
// refused, with that reason.
constexpr std::int64_t kIsolationNs = 1'000'000'000;

constexpr std::int64_t kConditionsPeriodNs = 100'000'000;  // as control_status

// Without an IMU sample for this long, the vehicle's clock is not used: it may have stopped.
constexpr double kVehicleClockStands_s = 0.5;

// The battery is sampled at 10 Hz only. Well below battery_timeout_s, so that a restarted vehicle is heard in time.
constexpr auto kBatterySourceSilence = 1000ms;

}  // namespace

ControlService::ControlService(const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                               int failover_priority, dds::Node& node,
                               const runtime::RealtimeSettings& realtime, runtime::Clock clock,
                               std::vector<control::FixedSetting> fixed,
                               std::optional<plant::ControlLevel> level)
    : controller_(runtime::random_id()),
      clock_(clock),
      realtime_(realtime),
      loop_(vehicle, settings),
      command_server_(loop_, vehicle, settings, GainDesigner(vehicle, settings, std::move(fixed)), wake_),
      telemetry_(loop_, command_server_, settings.failsafe, node, controller_,
                 control::observed_rotors(vehicle.motor.time_constant_s, settings)),
      failover_(controller_, failover_priority),
      reports_(node.publish(topics::kControllerState)),
      commands_(node, vehicle.rotor_count()),
      rotor_count_(vehicle.rotor_count()),
      wanted_level_(level),
      command_term_(failover_.next_term()),
      active_heard_ns_(runtime::monotonic_ns()) {
  report_.controller = controller_;
  report_.failover_priority = failover_priority;
  report_.rotor_count = vehicle.rotor_count();
  loop_.levels.put({plant::ControlLevel::kActuators, wanted_level_});
  command_server_.set_active(clock == runtime::Clock::kLockstep);
  subscribe(node, clock);
}

void ControlService::subscribe_sensors(dds::Node& node, runtime::Clock clock) {
  using Stream = LockstepGate::Stream;
  std::function<void(const msg::MocapPose&)> take_pose;
  std::function<void(const msg::Battery&)> take_battery;
  std::function<void(const msg::RotorSpeeds&)> take_rotor_speeds;
  // In real time no other topic may delay IMU and poses. In lockstep threads of their own only cost wake-ups.
  const Delivery delivery = clock == runtime::Clock::kLockstep ? Delivery::kShared : Delivery::kSensors;
  if (clock == runtime::Clock::kLockstep) {
    take_pose = deliver_in_lockstep<msg::MocapPose>(loop_.pose, pose_faults_, Stream::kPose);
    take_battery = deliver_in_lockstep<msg::Battery>(loop_.battery, battery_faults_, Stream::kBattery);
    take_rotor_speeds =
        deliver_in_lockstep<msg::RotorSpeeds>(loop_.rotor_speeds, rotor_speed_faults_, Stream::kRotorSpeeds);
  } else {
    take_pose = deliver<msg::MocapPose>(loop_.pose, pose_faults_);
    take_battery = deliver<msg::Battery>(loop_.battery, battery_faults_);
    take_rotor_speeds = deliver<msg::RotorSpeeds>(loop_.rotor_speeds, rotor_speed_faults_);
    telemetry_.watch_imu();
  }

  // Poses are needed to hold position: their thread has real-time priority, like the IMU's.
  sensors_.push_back({"poses", node.subscribe<msg::MocapPose>(
                                   topics::kMocapPose,
                                   [this, take_pose](const auto& message) {
                                     pose_thread_.enter(realtime_);
                                     // 0: a heartbeat of motion capture in lockstep, which is no pose
                                     if (message.sequence_number() == 0) return;
                                     note(pose_arrivals_, message);
                                     take_pose(message);
                                   },
                                   delivery, dds::kSourceSilence)});
  sensors_.push_back({"battery samples", node.subscribe<msg::Battery>(
                                             topics::kBattery,
                                             [this, take_battery](const auto& message) {
                                               note(battery_arrivals_, message);
                                               take_battery(message);
                                             },
                                             Delivery::kShared, kBatterySourceSilence)});
  // Rotor speeds can be as many as IMU samples. In the shared thread they would hold up the requests.
  sensors_.push_back({"rotor speeds", node.subscribe<msg::RotorSpeeds>(
                                          topics::kRotorSpeeds,
                                          [this, take_rotor_speeds](const auto& message) {
                                            rotor_speed_thread_.enter(realtime_);
                                            take_rotor_speeds(message);
                                          },
                                          delivery, dds::kSourceSilence)});
}

void ControlService::subscribe(dds::Node& node, runtime::Clock clock) {
  subscribe_sensors(node, clock);
  subscriptions_.push_back(node.subscribe<msg::VehicleInfo>(
      topics::kVehicleInfo, [this](const auto& message) { on_vehicle_info(message); }));
  subscriptions_.push_back(node.subscribe<msg::Setpoint>(
      topics::kSetpoint, deliver<msg::Setpoint>(loop_.setpoint, setpoint_faults_)));
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
  if (clock == runtime::Clock::kRealtime) {
    subscriptions_.push_back(node.subscribe<msg::Mission>(
        topics::kFlownMission, deliver_to_worker(&CommandServer::on_flown_mission), Delivery::kPlans));
    subscriptions_.push_back(node.subscribe<msg::Trajectory>(
        topics::kFlownTrajectory, deliver_to_worker(&CommandServer::on_flown_trajectory), Delivery::kPlans));
    subscriptions_.push_back(node.subscribe<msg::ControllerState>(
        topics::kControllerState, [this](const auto& message) { on_controller_state(message); },
        Delivery::kPlans));
  }
  subscribe_motion(node, topics::kVehicleOdometry, "vehicle_odometry samples",
                   AnsweredSamples::Kind::kOdometry);
  subscribe_motion(node, topics::kImu, "IMU samples", AnsweredSamples::Kind::kImu);
}

// The samples that are answered: of the IMU, or the vehicle's own estimates in place of them.
template <class Message>
void ControlService::subscribe_motion(dds::Node& node, const messages::Topic<Message>& topic,
                                      const char* samples, AnsweredSamples::Kind kind) {
  const bool lockstep = clock_ == runtime::Clock::kLockstep;
  const auto take = [this, kind, lockstep](const Message& message) {
    if (!answered_samples_.admit(kind, runtime::monotonic_ns())) return;
    note(imu_arrivals_, message);
    if (lockstep) {
      on_sample_in_lockstep(vehicle_sample(message));
    } else {
      on_sample(vehicle_sample(message));
    }
  };
  const Delivery delivery = lockstep ? Delivery::kShared : Delivery::kSamples;
  sensors_.push_back({samples, node.subscribe<Message>(topic, take, delivery, dds::kSourceSilence)});
}

template <class Message>
void ControlService::note(Arrivals& arrivals, const Message& message) {
  arrivals.note(message.stamp_ns(), message.sequence_number(), runtime::monotonic_ns());
}

// Returns a callback that passes valid samples to the inner loop and warns of invalid ones.
template <class Message, class Sample>
std::function<void(const Message&)> ControlService::deliver(runtime::LatestValue<Sample>& latest,
                                                            dds::ThrottledWarning& faults) {
  return [&latest, &faults](const Message& message) {
    Sample sample;
    const messages::Fault fault = messages::from_message(message, sample);
    if (fault) return faults.note(fault);
    latest.put(sample);
  };
}

template <class Message>
std::function<void(const Message&)> ControlService::deliver_to_worker(
    void (CommandServer::*take)(const Message&)) {
  return [this, take](const Message& message) {
    worker_.post([this, take, message] { (command_server_.*take)(message); });
  };
}

template <class Message, class Sample>
std::function<void(const Message&)> ControlService::deliver_in_lockstep(runtime::LatestValue<Sample>& latest,
                                                                        dds::ThrottledWarning& faults,
                                                                        LockstepGate::Stream stream) {
  return [this, stream, take = deliver<Message>(latest, faults)](const Message& message) {
    const std::lock_guard<std::mutex> lock(gate_mutex_);
    if (!gate_.is_new(stream, message.sequence_number())) return;
    take(message);
    if (const auto sample = gate_.take()) answer(*sample, take_role_in_lockstep(*sample));
  };
}

// The hot path: from the sample to its command. A plant in lockstep repeats a sample while its time stands still: the
// pending requests are answered, and the same command is published again.
void ControlService::on_sample(const VehicleSample& sample) {
  imu_thread_.enter(realtime_);
  const bool repeated = sample.stamp_ns() == answered_.stamp_ns && sample.sequence() == answered_.sequence;
  if (!repeated) {
    answered_ = {sample.stamp_ns(), sample.sequence()};
    return answer(sample, take_role(sample));
  }
  loop_.answer_requests();
  if (failover_.role() == Role::kActive && !loop_.detecting_airborne()) commands_.publish(last_answer_);
  if (loop_.finish(runtime::monotonic_ns(), failover_.loop_delay().figures())) wake_.post();
}

// The inner loop uses the other controllers' states from the next IMU sample on.
void ControlService::on_controller_state(const msg::ControllerState& message) {
  if (message.controller() == controller_) return;
  messages::ControllerReport other;
  const messages::Fault fault = messages::from_message(message, other);
  if (fault) return controller_faults_.note(fault);
  const std::int64_t now_ns = runtime::monotonic_ns();
  if (other.active) {
    active_heard_ns_.store(now_ns, std::memory_order_relaxed);
    if (!active_.load(std::memory_order_relaxed)) {
      FailoverState failover_state;
      failover_state.term = other.term;
      failover_state.flight = other.flight;
      command_server_.follow(failover_state);
    }
  }
  heartbeats_.push({other.controller, other.failover_priority, other.term,
                    other.active ? Role::kActive : Role::kStandby, now_ns});
}

Role ControlService::take_role(const VehicleSample& sample) {
  const Role before = failover_.role();
  heartbeats_.consume_all([this](const Heartbeat& beat) { failover_.heard(beat); });
  const std::int64_t now_ns = runtime::monotonic_ns();
  const Role role = failover_.sample(sample.stamp_ns(), sample.obeyed, now_ns);
  const bool active = role == Role::kActive;
  command_server_.set_active(active);
  active_.store(active, std::memory_order_relaxed);
  command_term_.store(active ? failover_.term() : failover_.next_term(), std::memory_order_relaxed);
  if (role != before) {
    const bool flew = sample.obeyed.reported && sample.obeyed.any;
    if (active && flew && !failover_.continues()) loop_.attempt_restart_in_air();
  }
  Takeover takeover;
  if (failover_.take_takeover(takeover)) {
    takeover_.put(takeover);
    wake_.post();
  }
  return role;
}

// A lockstep controller is active from the first sample on. Another term in a sample reveals a rival.
Role ControlService::take_role_in_lockstep(const VehicleSample& sample) {
  if (sample.obeyed.any && sample.obeyed.term != failover_.next_term()) {
    rival_.store(true, std::memory_order_relaxed);
    wake_.post();
    return Role::kStandby;
  }
  return Role::kActive;
}

// While simulated time stands still, the plant repeats a sample that was answered before: the pending
// requests are answered, and the same command is published again.
void ControlService::on_sample_in_lockstep(const VehicleSample& sample) {
  const std::lock_guard<std::mutex> lock(gate_mutex_);
  if (!levels_known_.load(std::memory_order_acquire)) return;  // the plant sends the sample again
  if (!gate_.offer(sample)) {
    loop_.answer_requests();
    commands_.publish(last_answer_);
    if (loop_.finish(runtime::monotonic_ns())) wake_.post();
  } else if (const auto complete = gate_.take()) {
    answer(*complete, take_role_in_lockstep(*complete));
  }
}

// A heartbeat that finds the queue full is lost; the tool repeats it.
void ControlService::on_ground_link(const msg::GroundLink& message) {
  control::GroundHeartbeat heartbeat;
  const messages::Fault fault = messages::from_message(message, heartbeat);
  if (fault) return ground_link_faults_.note(fault);
  loop_.ground_heartbeats.push(heartbeat);
}

void ControlService::answer(const VehicleSample& sample, Role role) {
  const std::int64_t arrived_ns = runtime::monotonic_ns();
  loop_.set_obeyed(sample.obeyed);
  last_answer_ = std::visit(
      [&](const auto& motion) { return loop_.step(motion, arrived_ns, role, failover_.followed_term()); },
      sample.motion);
  plant::header_of(last_answer_).term =
      clock_ == runtime::Clock::kLockstep ? failover_.next_term() : failover_.term();
  if (role == Role::kActive && !loop_.detecting_airborne()) commands_.publish(last_answer_);
  if (loop_.finish(runtime::monotonic_ns(), failover_.loop_delay().figures())) wake_.post();
  if (loop_.report_due()) report(sample.stamp_ns());
}

void ControlService::report(std::int64_t stamp_ns) {
  report_.stamp_ns = stamp_ns;
  ++report_.sequence;
  report_.term = plant::header_of(last_answer_).term;
  loop_.report(report_);
  reports_.publish(messages::to_message(report_));
}

void ControlService::run(const std::atomic<bool>& stop) {
  std::int64_t conditions_due_ns = 0;
  while (!stop.load(std::memory_order_relaxed)) {
    adopt_levels();
    Takeover takeover;
    if (takeover_.take(takeover)) runtime::log_warning("{}", to_string(takeover));
    const StreamAges ages = stream_ages();
    publish_pending_stop(ages);
    telemetry_.set_ages(ages);
    if (const std::int64_t now_ns = runtime::monotonic_ns(); now_ns >= conditions_due_ns) {
      telemetry_.set_conditions(is_realtime(), source_conflict());
      conditions_due_ns = now_ns + kConditionsPeriodNs;
    }
    telemetry_.publish_due();
    activate_if_isolated();
    wake_.wait_for(50ms);
  }
}

void ControlService::on_vehicle_info(const msg::VehicleInfo& message) {
  const std::string foreign = messages::fault_of_wire_version(message.wire_version(), "the vehicle");
  if (!foreign.empty()) return refuse_vehicle(foreign);
  if (refused_vehicle_) loop_.vehicle_refusal.put({});
  refused_vehicle_ = false;
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

// The vehicle cannot be armed until a vehicle_info of this version comes; a flight goes on. In lockstep its samples are
// answered, so that requests are.
void ControlService::refuse_vehicle(const std::string& why) {
  if (reported_levels_.load(std::memory_order_relaxed) != 0)
    return;  // known: this is another process's message
  if (!refused_vehicle_) runtime::log_error("{}: it cannot be armed", why);
  refused_vehicle_ = true;
  control::VehicleFault refusal{};
  std::copy_n(why.c_str(), std::min(why.size(), refusal.size() - 1), refusal.begin());
  loop_.vehicle_refusal.put(refusal);
  levels_known_.store(true, std::memory_order_release);
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
  levels_known_.store(true, std::memory_order_release);
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
  header.term = command_term_.load(std::memory_order_relaxed);
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

bool ControlService::is_realtime() const {
  return imu_thread_.is_realtime() && (pose_thread_.is_realtime() || !pose_thread_.has_entered());
}

void ControlService::activate_if_isolated() {
  const std::int64_t last_ns =
      std::max(loop_.last_arrival_ns(), active_heard_ns_.load(std::memory_order_relaxed));
  if (runtime::monotonic_ns() - last_ns > kIsolationNs) command_server_.set_active(true);
}

}  // namespace swiftlet::services

#include "swiftlet/ground/cli/check/sample_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
namespace topics = messages::topics;
namespace msg = messages::msg;

constexpr auto kClockPeriod = 50ms;
constexpr std::int64_t kAlive_ns = 1'000'000'000;  // since the last sign of a controller

dds::NodeSettings listening(dds::NodeSettings settings) {
  settings.name = "ground";
  return settings;
}

messages::Fault convert(const msg::Imu& message, ImuReport& out) {
  const messages::Fault fault = messages::from_message(message, out.imu);
  out.obeyed = messages::from_message(message.obeyed());
  out.lockstep = message.lockstep().mocap_pose() > 0 || message.lockstep().battery() > 0;
  return fault;
}
messages::Fault convert(const msg::VehicleOdometry& message, OdometryReport& out) {
  const messages::Fault fault = messages::from_message(message, out.odometry);
  out.obeyed = messages::from_message(message.obeyed());
  out.lockstep = message.lockstep().mocap_pose() > 0 || message.lockstep().battery() > 0;
  return fault;
}
template <class Message, class Sample>
messages::Fault convert(const Message& message, Sample& out) {
  return messages::from_message(message, out);
}

std::string conflict_of(const dds::Subscription& subscription) {
  const auto conflict = subscription.source_conflict();
  return conflict ? conflict->used.to_string() + " and " + conflict->ignored.to_string() : "";
}

template <class Sample>
void add_state(TopicRecord<Sample>& record, const dds::Subscription& subscription) {
  record.published = subscription.matched() > 0;
  record.conflict = conflict_of(subscription);
}

}  // namespace

SampleRecorder::SampleRecorder(const dds::NodeSettings& settings)
    : vehicle_(settings.vehicle),
      client_(runtime::random_id()),
      node_(listening(settings)),
      clock_(node_.publish(topics::kClockRequest)) {
  recording_.begin_ns = now_ns();
  node_.on_peer([this](const dds::PeerEvent& event) { count_peer(event); });
  const auto subscribe = [this](const auto& topic, auto& record) {
    using Message = typename std::decay_t<decltype(topic)>::Message;
    return node_.subscribe<Message>(
        topic, [this, &record](const Message& message) { take(record, message); }, dds::Delivery::kSamples,
        dds::OneSource{dds::kSourceSilence});
  };
  imu_ = subscribe(topics::kImu, recording_.imu);
  odometry_ = subscribe(topics::kVehicleOdometry, recording_.odometry);
  battery_ = subscribe(topics::kBattery, recording_.battery);
  mocap_ = subscribe(topics::kMocapPose, recording_.mocap);
  rotor_speeds_ = subscribe(topics::kRotorSpeeds, recording_.rotor_speeds);
  info_ = node_.subscribe<msg::VehicleInfo>(topics::kVehicleInfo, [this](const msg::VehicleInfo& info) {
    const std::lock_guard lock(mutex_);
    recording_.description = {info.name().c_str(),
                              info.simulated(),
                              info.rotor_count(),
                              info.mass_kg(),
                              info.imu_rate_hz(),
                              plant::ControlLevels::from_bits(info.control_levels()),
                              info.full_battery_v(),
                              info.empty_battery_v(),
                              messages::fault_of_wire_version(info.wire_version(), "the vehicle")};
    recording_.rotors_running.push_back({info.rotors_running(), now_ns()});
  });
  clock_replies_ =
      node_.subscribe<msg::ClockReply>(topics::kClockReply, [this](const msg::ClockReply& reply) {
        const std::int64_t at_ns = now_ns();
        const std::lock_guard lock(mutex_);
        if (reply.client() == client_)
          recording_.clock.push_back({reply.sent_ns(), reply.received_ns(), reply.answered_ns(), at_ns});
      });
  controller_states_ = node_.subscribe<msg::ControllerState>(topics::kControllerState, [this](const auto&) {
    const std::lock_guard lock(mutex_);
    controller_ns_ = runtime::monotonic_ns();
  });
  actuator_commands_ = node_.subscribe<msg::ActuatorCommand>(
      topics::kActuatorCommand, [this](const msg::ActuatorCommand& command) { take_command(command); });
}

template <class Message, class Sample>
void SampleRecorder::take(TopicRecord<Sample>& record, const Message& message) {
  Received<Sample> received;
  received.received_ns = now_ns();
  const messages::Fault fault = convert(message, received.sample);
  const std::lock_guard lock(mutex_);
  if (!fault) {
    record.samples.push_back(received);
    return;
  }
  if (record.invalid++ == 0) record.fault = fault.text;
}

void SampleRecorder::take_command(const msg::ActuatorCommand& command) {
  const std::lock_guard lock(mutex_);
  const auto known = std::find_if(commands_.begin(), commands_.end(),
                                  [&](const HeardCommand& heard) { return heard.term == command.term(); });
  if (known == commands_.end()) {
    commands_.push_back({command.term(), runtime::monotonic_ns()});
  } else {
    known->received_ns = runtime::monotonic_ns();
  }
}

void SampleRecorder::count_peer(const dds::PeerEvent& event) {
  if (event.name != "control") return;
  const std::lock_guard lock(mutex_);
  controllers_ += event.alive ? 1 : -1;
}

std::int64_t SampleRecorder::now_ns() const {
  const std::int64_t since_ns = rated_since_ns_;
  const auto passed_ns = static_cast<double>(runtime::monotonic_ns() - since_ns);
  return since_ns + std::llround(vehicle_rate_ * passed_ns);
}

void SampleRecorder::restart(double vehicle_rate) {
  const std::lock_guard lock(mutex_);
  rated_since_ns_ = runtime::monotonic_ns();
  vehicle_rate_ = vehicle_rate;
  recording_.begin_ns = now_ns();
  const auto forget = [](auto& record) {
    record.samples.clear();
    record.invalid = 0;
  };
  forget(recording_.imu);
  forget(recording_.odometry);
  forget(recording_.battery);
  forget(recording_.mocap);
  forget(recording_.rotor_speeds);
  recording_.clock.clear();
  // The last report of the rotors stays valid.
  if (recording_.rotors_running.size() > 1)
    recording_.rotors_running.erase(recording_.rotors_running.begin(), recording_.rotors_running.end() - 1);
}

bool SampleRecorder::record(std::chrono::milliseconds time, const std::function<bool()>& cancelled) {
  const auto end = std::chrono::steady_clock::now() + time;
  for (;;) {
    if (cancelled()) return false;
    ask_clock();
    const auto left = end - std::chrono::steady_clock::now();
    if (left <= 0ms) return true;
    std::this_thread::sleep_for(std::min<std::chrono::nanoseconds>(left, kClockPeriod));
  }
}

void SampleRecorder::ask_clock() {
  msg::ClockRequest request;
  request.client(client_);
  request.sequence_number(++clock_requests_);
  request.sent_ns(now_ns());
  clock_.publish(request);
}

VehicleRecording SampleRecorder::recording() const {
  VehicleRecording recording;
  {
    const std::lock_guard lock(mutex_);
    recording = recording_;
  }
  recording.end_ns = now_ns();
  recording.mismatches = node_.mismatches_seen();
  add_state(recording.imu, imu_);
  add_state(recording.odometry, odometry_);
  add_state(recording.battery, battery_);
  add_state(recording.mocap, mocap_);
  add_state(recording.rotor_speeds, rotor_speeds_);
  return recording;
}

bool SampleRecorder::hears_vehicle() const {
  const std::lock_guard lock(mutex_);
  return !recording_.imu.samples.empty() || !recording_.odometry.samples.empty();
}

std::optional<Received<plant::PoseSample>> SampleRecorder::newest_tracked_pose() const {
  const std::lock_guard lock(mutex_);
  const auto& samples = recording_.mocap.samples;
  if (samples.empty() || !samples.back().sample.tracked) return std::nullopt;
  return samples.back();
}

std::optional<ImuReport> SampleRecorder::newest_imu() const {
  const std::lock_guard lock(mutex_);
  const auto& samples = recording_.imu.samples;
  return samples.empty() ? std::nullopt : std::optional(samples.back().sample);
}

std::int64_t SampleRecorder::imu_silence_ns() const {
  const std::lock_guard lock(mutex_);
  const auto& samples = recording_.imu.samples;
  const std::int64_t silence_ns =
      now_ns() - (samples.empty() ? recording_.begin_ns : samples.back().received_ns);
  return std::llround(static_cast<double>(silence_ns) / vehicle_rate_);
}

std::string SampleRecorder::other_controller(const std::set<std::uint32_t>& own_terms) const {
  const std::int64_t now_ns = runtime::monotonic_ns();
  const std::lock_guard lock(mutex_);
  if (controllers_ > 0 || (controller_ns_ != 0 && now_ns - controller_ns_ < kAlive_ns))
    return "a control service for " + vehicle_ + " is alive";
  const bool commanded = std::any_of(commands_.begin(), commands_.end(), [&](const HeardCommand& heard) {
    return own_terms.count(heard.term) == 0 && now_ns - heard.received_ns < kAlive_ns;
  });
  return commanded ? "another process sends actuator_command to " + vehicle_ : "";
}

}  // namespace swiftlet::ground

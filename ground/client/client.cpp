#include "swiftlet/ground/client/client.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "swiftlet/control/estimation/estimator.hpp"
#include "swiftlet/control/types/mode.hpp"
#include "swiftlet/ground/client/discovery.hpp"
#include "swiftlet/io/text.hpp"
#include "swiftlet/services/dds/reach.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/messages/wire_version.hpp"
#include "swiftlet/services/runtime/random_id.hpp"

namespace swiftlet::ground {
namespace {

constexpr std::chrono::milliseconds kResendPeriod{2000};  // without an answer
constexpr std::size_t kMaxReportedRequests = 64;
constexpr std::chrono::milliseconds kPollPeriod{20};  // for conditions that do not notify changed_
// How far a lockstep plant may run ahead: 50 samples of the IMU at 500 Hz, which the sockets of a recorder hold.
constexpr std::int64_t kTelemetryWindowNs = 100'000'000;

Result result_of(const msg::CommandAck& ack) {
  const control::RequestKey key{ack.client(), ack.id()};
  if (ack.accepted()) return {Result::Kind::kAccepted, ack.reason().c_str(), key, ack.stamp_ns()};
  return {Result::Kind::kRefused, ack.reason().c_str(), key};
}

bool is_in_mission(const msg::ControlStatus& status) {
  return static_cast<control::Mode>(status.mode()) == control::Mode::kMission;
}

}  // namespace

Client::Client(const dds::NodeSettings& settings) : Client(nullptr, settings, Telemetry::kReceived) {}

Client::Client(const dds::Participant& participant, const dds::NodeSettings& settings, Telemetry telemetry)
    : Client(&participant, settings, telemetry) {}

Client::Client(const dds::Participant* shared, const dds::NodeSettings& settings, Telemetry telemetry)
    : settings_(settings),
      client_id_(runtime::random_id()),
      last_id_(runtime::random_id() >> 1),
      node_(shared != nullptr ? dds::Node(*shared, settings.vehicle) : dds::Node(settings)),
      commands_(node_.publish(messages::topics::kCommand)),
      missions_(node_.publish(messages::topics::kMission)),
      trajectories_(node_.publish(messages::topics::kTrajectory)),
      settings_changes_(node_.publish(messages::topics::kControlSettings)),
      setpoints_(node_.publish(messages::topics::kSetpoint)) {
  subscribe_statuses();
  if (telemetry == Telemetry::kReceived) subscribe_telemetry();
  node_.on_peer([this](const dds::PeerEvent& peer) {
    {
      const std::lock_guard lock(mutex_);
      view_.peers[peer.name] += peer.alive ? 1 : -1;
    }
    changed_.notify_all();
  });
}

template <class T>
void Client::keep(Latest<T> View::*slot, const T& message) {
  const std::lock_guard lock(mutex_);
  Latest<T>& latest = view_.*slot;
  latest.message = message;
  latest.received = Clock::now();
  ++latest.count;
}

void Client::note_requests(const msg::ControlStatus& status) {
  const std::lock_guard lock(mutex_);
  const auto note = [this](const msg::RequestStatus& request) {
    if (request.client() == client_id_) reported_[request.id()] = request;
  };
  for (const msg::RequestStatus& request : status.earlier_requests()) note(request);
  note(status.request());
  while (reported_.size() > kMaxReportedRequests) reported_.erase(reported_.begin());
}

std::optional<msg::RequestStatus> Client::reported_status(const control::RequestKey& request) const {
  const std::lock_guard lock(mutex_);
  const auto reported = reported_.find(request.id);
  if (request.client != client_id_ || reported == reported_.end()) return std::nullopt;
  return reported->second;
}

// Statuses, answers and peer events wake waiting threads.
void Client::subscribe_statuses() {
  using namespace messages::topics;
  subscriptions_.push_back(
      node_.subscribe<msg::ControlStatus>(kControlStatus, [this](const msg::ControlStatus& status) {
        const std::string fault = messages::fault_of_wire_version(status.wire_version(), "control");
        {
          const std::lock_guard lock(mutex_);
          view_.foreign_control = fault;
        }
        if (!fault.empty()) return changed_.notify_all();
        {
          // Each controller counts its own statuses: a count that does not rise is another controller's.
          const std::lock_guard lock(mutex_);
          const msg::ControlStatus& before = view_.control.message;
          if (status.sequence_number() <= before.sequence_number()) ++takeovers_;
          if (is_in_mission(before) && !is_in_mission(status)) view_.left_mission_ns = status.stamp_ns();
        }
        note_requests(status);
        keep(&View::control, status);
        changed_.notify_all();
      }));
  subscriptions_.push_back(
      node_.subscribe<msg::MissionStatus>(kMissionStatus, [this](const msg::MissionStatus& status) {
        keep(&View::mission, status);
        changed_.notify_all();
      }));
  subscriptions_.push_back(
      node_.subscribe<msg::VehicleInfo>(kVehicleInfo, [this](const msg::VehicleInfo& info) {
        if (info.wire_version() != messages::kWireVersion) return;  // control refuses it by a sentence
        keep(&View::vehicle, info);
        advance_after(info.stamp_ns());
        changed_.notify_all();
      }));
  subscriptions_.push_back(node_.subscribe<msg::CommandAck>(kCommandAck, [this](const msg::CommandAck& ack) {
    if (ack.client() != client_id_) return;
    {
      const std::lock_guard lock(mutex_);
      const auto asked = answers_.find(ack.id());
      if (asked != answers_.end()) asked->second = result_of(ack);
    }
    changed_.notify_all();
  }));
}

// Does not wake waiting threads: its rate is too high.
void Client::subscribe_telemetry() {
  using namespace messages::topics;
  subscriptions_.push_back(node_.subscribe<msg::Battery>(
      kBattery, [this](const msg::Battery& battery) { keep(&View::battery, battery); }));
  subscriptions_.push_back(node_.subscribe<msg::Estimate>(
      kEstimate, [this](const msg::Estimate& estimate) { keep(&View::estimate, estimate); }));
  subscriptions_.push_back(
      node_.subscribe<msg::Reference>(kReference, [this](const msg::Reference& reference) {
        keep(&View::reference, reference);
        advance_after(reference.stamp_ns());
        std::unique_lock lock(mutex_);
        const auto heartbeat = heartbeat_;
        lock.unlock();
        if (heartbeat) heartbeat->telemetry(reference.stamp_ns());
      }));
  subscriptions_.push_back(node_.subscribe<msg::GroundTruth>(
      kGroundTruth, [this](const msg::GroundTruth& truth) { keep(&View::truth, truth); }));
  subscriptions_.push_back(node_.subscribe<msg::ClockStatus>(
      kClockStatus, [this](const msg::ClockStatus& status) { keep(&View::clock, status); }));
}

void Client::hear_controllers() {
  subscriptions_.push_back(node_.subscribe<msg::ControllerState>(
      messages::topics::kControllerState, [this](const msg::ControllerState& state) {
        const std::lock_guard lock(mutex_);
        Latest<msg::ControllerState>& latest = view_.controllers[state.controller()];
        latest.message = state;
        latest.received = Clock::now();
        ++latest.count;
      }));
}

void Client::hear_files() {
  subscriptions_.push_back(
      node_.subscribe<msg::FlownFiles>(messages::topics::kFlownFiles, [this](const msg::FlownFiles& files) {
        {
          const std::lock_guard lock(mutex_);
          view_.files = std::make_shared<const msg::FlownFiles>(files);
        }
        changed_.notify_all();
      }));
}

View Client::view() const {
  const std::lock_guard lock(mutex_);
  return view_;
}

SimulationClockPublisher& Client::simulation_clock() {
  std::unique_lock lock(mutex_);
  if (clock_publisher_) return *clock_publisher_;
  lock.unlock();
  auto simulation_clock = std::make_shared<SimulationClockPublisher>(node_, kTelemetryWindowNs);
  lock.lock();
  clock_publisher_ = std::move(simulation_clock);
  return *clock_publisher_;
}

void Client::advance_after(std::int64_t stamp_ns) {
  come_ns_ = std::max(come_ns_.load(), stamp_ns);  // of the one thread that receives both
  advance();
}

void Client::has_been_recorded(std::int64_t stamp_ns) {
  recorded_ns_ = stamp_ns;
  advance();
}

void Client::advance() {
  std::unique_lock lock(mutex_);
  const auto simulation_clock = clock_publisher_;
  lock.unlock();
  const std::int64_t recorded_ns = recorded_ns_;
  if (simulation_clock)
    simulation_clock->has_come(recorded_ns < 0 ? come_ns_.load() : std::min(come_ns_.load(), recorded_ns));
}

void Client::enable_link_loss_failsafe() {
  std::unique_lock lock(mutex_);
  if (heartbeat_) return;
  lock.unlock();
  auto heartbeat = std::make_shared<GroundHeartbeatPublisher>(node_, client_id_);
  lock.lock();
  heartbeat_ = std::move(heartbeat);
}

void Client::disable_link_loss_failsafe() {
  std::shared_ptr<GroundHeartbeatPublisher> heartbeat;
  const std::lock_guard lock(mutex_);
  heartbeat_.swap(heartbeat);  // destroyed after the lock is released
}

bool Client::wait(std::chrono::milliseconds timeout, const std::function<bool(const View&)>& done) const {
  const auto deadline = Clock::now() + timeout;
  std::unique_lock lock(mutex_);
  while (!done(view_)) {
    const auto now = Clock::now();
    if (now >= deadline) return false;
    changed_.wait_until(lock, std::min(deadline, now + kPollPeriod));
  }
  return true;
}

namespace {

// When a request was sent, and to which readers and controller. If these change, it is sent again.
struct Sending {
  Clock::time_point at;
  std::uint64_t reader_changes = 0;
  std::uint64_t takeovers = 0;

  bool reached_all(const Sending& now) const {
    return now.reader_changes == reader_changes && now.takeovers == takeovers && now.at < at + kResendPeriod;
  }
};

}  // namespace

template <class T>
Result Client::ask(dds::Publisher<T>& publisher, const T& request, std::chrono::milliseconds timeout,
                   const Cancelled& cancelled) {
  const auto deadline = Clock::now() + timeout;
  std::optional<Sending> sent;

  std::unique_lock lock(mutex_);
  const auto asked = answers_.emplace(request.id(), std::nullopt).first;
  const auto settled = [&](Result answer) {
    answers_.erase(asked);
    return answer;
  };
  while (!asked->second) {
    const auto now = Clock::now();
    if (cancelled && cancelled()) return settled({Result::Kind::kCancelled, "the request was cancelled"});
    if (now >= deadline) {
      settled({});
      lock.unlock();
      if (sent) {
        return {Result::Kind::kSilence, "no answer from the control service of " + where() +
                                            "; `swiftlet status` shows whether it still runs"};
      }
      return {Result::Kind::kNoControl, no_control()};
    }
    Sending sending{now, 0, takeovers_};
    lock.unlock();
    const bool has_readers = publisher.matched() > 0;
    sending.reader_changes = publisher.changes();  // after matched(): counts every reader that it saw
    if (has_readers && !(sent && sent->reached_all(sending))) {
      const std::lock_guard one_at_a_time(sending_);
      publisher.publish(request);
      sent = sending;
    }
    lock.lock();
    if (asked->second) break;
    changed_.wait_until(lock, std::min(deadline, now + kPollPeriod));
  }
  return settled(*asked->second);
}

template <class T>
T Client::numbered(T message) {
  message.client(client_id_);
  message.id(++last_id_);
  return message;
}

Result Client::request(const control::Request& request, std::chrono::milliseconds timeout,
                       const Cancelled& cancelled) {
  return ask(commands_, numbered(messages::to_message(request)), timeout, cancelled);
}

Result Client::upload(const control::Mission& mission, std::chrono::milliseconds timeout,
                      const Cancelled& cancelled) {
  const msg::Mission message = numbered(messages::to_message(mission));
  mission_id_ = message.id();
  return ask(missions_, message, timeout, cancelled);
}

Result Client::upload(const control::Trajectory& trajectory, std::chrono::milliseconds timeout,
                      const Cancelled& cancelled) {
  return ask(trajectories_, numbered(messages::to_message(trajectory)), timeout, cancelled);
}

Result Client::change_settings(const control::SettingsRequest& settings, std::chrono::milliseconds timeout,
                               const Cancelled& cancelled) {
  return ask(settings_changes_, numbered(messages::to_message(settings)), timeout, cancelled);
}

bool Client::send(control::Setpoint setpoint) {
  setpoint.stamp_ns = view().estimate.message.stamp_ns();
  const std::lock_guard sending(sending_);
  setpoint.sequence = ++setpoint_count_;
  return setpoints_.matched() > 0 && setpoints_.publish(messages::to_message(setpoint));
}

void Client::await_setpoint_reader(Clock::time_point deadline, const Cancelled& cancelled) const {
  while (setpoints_.matched() == 0 && Clock::now() < deadline && !cancelled())
    wait(kPollPeriod, [&cancelled](const View&) { return cancelled(); });
}

std::string Client::where() const {
  std::vector<std::string> names;
  for (const auto& [name, count] : view().peers) {
    if (count > 0) names.push_back(name);
  }
  const std::string alive = listed(names);
  return "vehicle " + settings_.vehicle + " in domain " + std::to_string(settings_.domain) +
         "; processes found: " + (alive.empty() ? "none" : alive);
}

std::string Client::no_control() const {
  if (const std::string foreign = view().foreign_control; !foreign.empty()) return where() + ": " + foreign;
  std::string text = "no control service for " + where();
  const auto peers = view().peers;
  const auto control = peers.find("control");
  const bool seen = control != peers.end() && control->second > 0;
  const std::vector<std::string> topics = node_.topics_seen();
  const std::string own = listed(topics_of(settings_.vehicle, topics));
  if (!own.empty()) text += "; topics found: " + own;
  std::vector<std::string> others = vehicles_of(topics);
  others.erase(std::remove(others.begin(), others.end(), settings_.vehicle), others.end());
  if (!others.empty()) return text + "; other vehicles found: " + listed(others) + " (--vehicle-name)";
  if (seen || !own.empty()) return text;
  const std::vector<std::string> keys = node_.refused_keys();
  return text + "; " +
         (keys.empty() ? "is it running in this domain (--domain, ROS_DOMAIN_ID), with the key of this "
                         "process (--network-key, --security)?"
                       : io::joined(keys, "; "));
}

const char* pose_fault_name(std::uint8_t fault) {
  return control::to_string(static_cast<control::PoseFault>(fault));
}
const char* mode_name(std::uint8_t mode) { return control::to_string(static_cast<control::Mode>(mode)); }

const char* mission_state_name(std::uint8_t state) {
  switch (state) {
    case msg::MissionStatus_Constants::NONE:
      return "none";
    case msg::MissionStatus_Constants::RUNNING:
      return "running";
    case msg::MissionStatus_Constants::COMPLETED:
      return "completed";
    case msg::MissionStatus_Constants::ABORTED:
      return "aborted";
    case msg::MissionStatus_Constants::UPLOADED:
      return "uploaded";
    case msg::MissionStatus_Constants::PAUSED:
      return "paused";
    default:
      return "unknown";
  }
}

}  // namespace swiftlet::ground

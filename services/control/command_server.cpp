#include "swiftlet/services/control/command_server.hpp"

#include <cstdio>
#include <tuple>
#include <utility>

#include "swiftlet/control/design/battery_limits.hpp"
#include "swiftlet/control/planning/checks.hpp"
#include "swiftlet/control/planning/feasibility.hpp"
#include "swiftlet/services/control/arrivals.hpp"
#include "swiftlet/services/messages/convert.hpp"
#include "swiftlet/services/runtime/log.hpp"
#include "swiftlet/services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::size_t kRememberedAnswers = 256;
constexpr std::int64_t kPatienceNs = 500'000'000;
constexpr std::int64_t kStopPatienceNs = 50'000'000;
constexpr std::size_t kMostOtherRequests = kMaxPendingRequests - 1;  // a stop always has room

control::Outcome accept_with(const char* reason) {
  control::Outcome outcome = control::accept();
  std::snprintf(outcome.reason, sizeof outcome.reason, "%s", reason);
  return outcome;
}

control::Outcome stopped_without_imu(double imu_age_s) {
  if (imu_age_s < 0.0) {
    return accept_with(
        "rotors off is commanded, but no IMU sample of the vehicle has come yet: it cannot confirm the stop");
  }
  control::Outcome outcome = control::accept();
  std::snprintf(
      outcome.reason, sizeof outcome.reason,
      "rotors off is commanded, but the vehicle has been silent for %.1f s (no IMU sample): it cannot "
      "confirm the stop",
      imu_age_s);
  return outcome;
}

// key: client and id of the request. stamp_ns: if accepted, as in CommandAck.
messages::msg::CommandAck answer_to(const std::pair<std::uint64_t, std::uint64_t>& key,
                                    const control::Outcome& outcome, std::int64_t stamp_ns) {
  messages::msg::CommandAck answer;
  answer.client(key.first);
  answer.id(key.second);
  answer.accepted(outcome.accepted);
  answer.reason() = outcome.reason;
  answer.stamp_ns(stamp_ns);
  return answer;
}

void log_answer(const char* kind, std::uint64_t id, const control::Outcome& outcome) {
  if (!outcome.accepted) {
    runtime::log_warning("{} {} refused: {}", kind, id, outcome.reason);
  } else if (outcome.reason[0] != '\0') {
    runtime::log_warning("{} {} accepted: {}", kind, id, outcome.reason);
  } else {
    runtime::log_info("{} {} accepted", kind, id);
  }
}

control::Outcome refusal(const messages::Fault& fault) { return control::refuse("%s", fault.text); }

// Reads the message into `plan` and checks that it can be flown.
template <class Message, class Plan>
control::Outcome read(const Message& message, const control::Limits& limits, Plan& plan) {
  const messages::Fault fault = messages::from_message(message, plan);
  return fault ? refusal(fault) : control::check(plan, limits);
}

}  // namespace

CommandServer::CommandServer(InnerLoop& loop, const plant::Vehicle& vehicle,
                             const control::ControlSettings& settings, GainDesigner designer, Semaphore& wake)
    : loop_(loop),
      vehicle_(vehicle),
      limits_(settings.limits),
      low_battery_voltage_(control::with_battery_limits(settings.failsafe, vehicle).low_battery_voltage),
      designer_(std::move(designer)),
      wake_(wake),
      gains_in_force_(designer_.initial()) {}

void CommandServer::on_command(const messages::msg::Command& message) {
  if (!active()) return;
  const Key key{message.client(), message.id()};
  if (!claim(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  const messages::Fault fault = messages::from_message(message, pending->request);
  if (fault) return refuse(key, static_cast<control::RequestKind>(message.kind()), refusal(fault));
  std::tie(pending->client, pending->id) = key;
  submit(std::move(pending));
}

void CommandServer::on_mission(const messages::msg::Mission& message) {
  if (!active()) return on_flown_mission(message);
  const Key key{message.client(), message.id()};
  if (!claim(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  pending->mission = std::make_unique<control::Mission>();
  control::Outcome outcome = read(message, limits_, *pending->mission);
  if (outcome.accepted) outcome = check_rotors("the mission", pending->mission->segments);
  if (!outcome.accepted) return refuse(key, control::RequestKind::kMissionUpload, outcome);
  std::tie(pending->client, pending->id) = key;
  pending->request.kind = control::RequestKind::kMissionUpload;
  pending->request.mission = pending->mission.get();
  submit(std::move(pending));
}

control::Outcome CommandServer::check_rotors(const char* what,
                                             const std::vector<control::PolynomialSegment>& segments) const {
  return control::check_rotors(what, vehicle_, limits_, low_battery_voltage_, segments);
}

void CommandServer::on_trajectory(const messages::msg::Trajectory& message) {
  if (!active()) return on_flown_trajectory(message);
  const Key key{message.client(), message.id()};
  if (!claim(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  pending->trajectory = std::make_unique<control::Trajectory>();
  control::Outcome outcome = read(message, limits_, *pending->trajectory);
  if (outcome.accepted) outcome = check_rotors("the trajectory", pending->trajectory->segments);
  if (!outcome.accepted) return refuse(key, control::RequestKind::kTrajectory, outcome);
  std::tie(pending->client, pending->id) = key;
  pending->request.kind = control::RequestKind::kTrajectory;
  pending->request.trajectory = pending->trajectory.get();
  submit(std::move(pending));
}

void CommandServer::on_control_settings(const messages::msg::ControlSettings& message) {
  if (!active()) return;
  const Key key{message.client(), message.id()};
  if (!claim(key)) return;
  control::SettingsRequest asked;
  control::ControlGains in_force;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    in_force = gains_in_force_;
  }
  auto pending = std::make_unique<PendingRequest>();
  pending->gains = std::make_unique<control::GainChange>();
  const messages::Fault fault = messages::from_message(message, asked);
  const control::Outcome outcome =
      fault ? refusal(fault) : designer_.design(asked, in_force, *pending->gains);
  if (!outcome.accepted) return refuse(key, control::RequestKind::kSettings, outcome);
  std::tie(pending->client, pending->id) = key;
  pending->request.kind = control::RequestKind::kSettings;
  pending->request.gains = pending->gains.get();
  submit(std::move(pending));
}

void CommandServer::set_gains_in_force(const control::ControlGains& gains) {
  const std::lock_guard<std::mutex> lock(mutex_);
  gains_in_force_ = gains;
}

// True if a stored or pending mission has the same id but different contents. The same contents are the same upload,
// repeated. Call with mutex_ held.
bool CommandServer::is_of_another(const control::Mission& mission) const {
  const control::Mission* known = missions_.find(mission.id);
  for (const auto& [key, pending] : pending_) {
    if (pending->mission && pending->mission->id == mission.id) known = pending->mission.get();
  }
  return known != nullptr && messages::to_message(*known) != messages::to_message(mission);
}

// A mission may arrive on two topics, `mission` and `flown_mission`, and repeatedly on each.
void CommandServer::on_flown_mission(const messages::msg::Mission& message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (missions_.find(message.id()) != nullptr) return;
  }
  auto mission = std::make_unique<control::Mission>();
  if (!read(message, limits_, *mission).accepted) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (missions_.find(message.id()) == nullptr) missions_.put(std::move(mission));
}

void CommandServer::on_flown_trajectory(const messages::msg::Trajectory& message) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (trajectories_.find(message.id()) != nullptr) return;
  }
  auto trajectory = std::make_unique<control::Trajectory>();
  if (!read(message, limits_, *trajectory).accepted) return;
  const std::lock_guard<std::mutex> lock(mutex_);
  if (trajectories_.find(message.id()) == nullptr) trajectories_.put(std::move(trajectory));
}

void CommandServer::follow(FailoverState failover_state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const control::SupervisorState& state = failover_state.flight.supervisor;
  failover_state.number = ++failover_states_;
  if (state.guidance.mission.state != control::MissionState::kNone)
    failover_state.mission = missions_.find(state.guidance.mission.id);
  if (state.mode == control::Mode::kTrajectory)
    failover_state.trajectory = trajectories_.find(state.guidance.trajectory_id);
  missions_.lend(failover_state.mission, failover_state.number);
  trajectories_.lend(failover_state.trajectory, failover_state.number);
  for (const control::RequestStatus& request : state.requests) {
    const Key key{request.key.client, request.key.id};
    if (request.key.id != 0 && answers_.count(key) == 0)
      keep_answer(key, answer_to(key, control::accept(), state.now_ns));
  }
  loop_.failover_state.put(failover_state);
  missions_.tidy(loop_.adopted_state());
  trajectories_.tidy(loop_.adopted_state());
}

messages::msg::Mission CommandServer::mission(std::uint64_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const control::Mission* const mission = missions_.find(id);
  return mission != nullptr ? messages::to_message(*mission) : messages::msg::Mission();
}

messages::msg::Trajectory CommandServer::trajectory(std::uint64_t id) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const control::Trajectory* const trajectory = trajectories_.find(id);
  return trajectory != nullptr ? messages::to_message(*trajectory) : messages::msg::Trajectory();
}

bool CommandServer::claim(const Key& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto given = answers_.find(key);
  if (given == answers_.end()) return pending_.count(key) == 0 && checked_.insert(key).second;
  runtime::log_debug("request {} is repeated: answered again", key.second);
  outbox_.push_back(given->second);
  wake_.post();
  return false;
}

void CommandServer::submit(std::unique_ptr<PendingRequest> pending) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Key key{pending->client, pending->id};
  checked_.erase(key);
  const bool stops = pending->request.kind == control::RequestKind::kStop;
  if (!stops && pending_.size() >= kMostOtherRequests) {
    return settle(key, pending->request.kind,
                  control::refuse("%zu requests are pending, the limit", kMostOtherRequests));
  }
  if (pending_.size() >= kMaxPendingRequests)  // the last one of them is a stop
    return settle(key, pending->request.kind, accept_with("another stop request is pending"));
  if (pending->mission && is_of_another(*pending->mission)) {
    return settle(key, pending->request.kind,
                  control::refuse("mission id %llu belongs to another mission: upload with a new id",
                                  static_cast<unsigned long long>(pending->mission->id)));
  }
  pending->request.key = {pending->client, pending->id};
  pending->asked_ns = runtime::monotonic_ns();
  loop_.requests.push(pending.get());  // always fits: at most kMaxPendingRequests
  pending_.emplace(key, std::move(pending));
  if (stops) wake_.post();
}

std::optional<control::RequestKey> CommandServer::accept_overdue_stop(double imu_age_s,
                                                                      std::int64_t stamp_ns) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool silent = imu_age_s < 0.0 || imu_age_s > kImuSilence_s;
  const std::int64_t now_ns = runtime::monotonic_ns();
  std::optional<control::RequestKey> stop;
  for (const auto& [key, pending] : pending_) {
    if (pending->request.kind != control::RequestKind::kStop) continue;
    if (pending->state.load(std::memory_order_acquire) != PendingRequest::State::kWaiting) continue;
    if (!silent && now_ns - pending->asked_ns < kStopPatienceNs) continue;
    stop = pending->request.key;
    if (std::exchange(pending->answered, true)) continue;
    settle(key, pending->request.kind,
           silent ? stopped_without_imu(imu_age_s)
                  : accept_with("rotors off is commanded, but the IMU samples of the vehicle are not usable: "
                                "it cannot confirm the stop"),
           stamp_ns);
  }
  return stop;
}

void CommandServer::refuse(const Key& key, control::RequestKind kind, const control::Outcome& outcome) {
  const std::lock_guard<std::mutex> lock(mutex_);
  checked_.erase(key);
  settle(key, kind, outcome);
}

// Call with mutex_ held.
void CommandServer::settle(const Key& key, control::RequestKind kind, const control::Outcome& outcome,
                           std::int64_t stamp_ns) {
  log_answer(control::to_string(kind), key.second, outcome);
  outbox_.push_back(answer_to(key, outcome, stamp_ns));
  keep_answer(key, outbox_.back());
  wake_.post();
}

// Call with mutex_ held.
void CommandServer::keep_answer(const Key& key, const messages::msg::CommandAck& answer) {
  if (answers_.insert_or_assign(key, answer).second) oldest_.push_back(key);
  if (oldest_.size() <= kRememberedAnswers) return;
  answers_.erase(oldest_.front());
  oldest_.pop_front();
}

std::vector<messages::msg::CommandAck> CommandServer::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  PendingRequest* evaluated = nullptr;
  while (loop_.evaluated.pop(evaluated)) {
    const Key key{evaluated->client, evaluated->id};
    const auto entry = pending_.find(key);
    const std::unique_ptr<PendingRequest> done = std::move(entry->second);
    pending_.erase(entry);
    if (done->answered || done->state == PendingRequest::State::kGivenUp) continue;
    if (done->outcome.accepted && done->mission) missions_.put_flown(std::move(done->mission));
    if (done->outcome.accepted && done->trajectory) trajectories_.put_flown(std::move(done->trajectory));
    settle(key, done->request.kind, done->outcome, done->stamp_ns);
  }
  missions_.tidy(loop_.adopted_state());
  trajectories_.tidy(loop_.adopted_state());
  const std::int64_t now_ns = runtime::monotonic_ns();
  for (const auto& [key, pending] : pending_) {
    if (pending->request.kind == control::RequestKind::kStop || now_ns - pending->asked_ns < kPatienceNs ||
        !pending->claim(PendingRequest::State::kGivenUp))
      continue;
    settle(key, pending->request.kind, control::refuse("no IMU samples arrive: is the vehicle running?"));
  }
  return std::exchange(outbox_, {});
}

}  // namespace swiftlet::services

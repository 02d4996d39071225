#include "services/control/request_desk.hpp"

#include <tuple>

#include "control/supervision/checks.hpp"
#include "services/comms/convert.hpp"
#include "services/runtime/periodic_timer.hpp"

namespace swiftlet::services {
namespace {

constexpr std::size_t kRememberedAnswers = 256;
constexpr std::int64_t kPatienceNs = 500'000'000;

const char* name_of(control::RequestKind kind) {
  switch (kind) {
    case control::RequestKind::kArm:
      return "arm";
    case control::RequestKind::kDisarm:
      return "disarm";
    case control::RequestKind::kTakeoff:
      return "takeoff";
    case control::RequestKind::kGoTo:
      return "goto";
    case control::RequestKind::kHold:
      return "hold";
    case control::RequestKind::kLand:
      return "land";
    case control::RequestKind::kStop:
      return "stop";
    case control::RequestKind::kMission:
      return "mission";
    case control::RequestKind::kTrajectory:
      return "trajectory";
  }
  return "request of unknown kind";
}

control::Outcome refusal(const comms::Fault& fault) { return control::refuse("%s", fault.text); }

}  // namespace

RequestDesk::RequestDesk(InnerLoop& loop, const control::Limits& limits, runtime::Semaphore& wake)
    : loop_(loop), limits_(limits), wake_(wake) {}

void RequestDesk::on_command(const comms::msg::Command& message) {
  const Key key{message.client(), message.id()};
  if (is_known(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  const comms::Fault fault = comms::from_message(message, pending->request);
  if (fault) return refuse(key, static_cast<control::RequestKind>(message.kind()), refusal(fault));
  std::tie(pending->client, pending->id) = key;
  submit(std::move(pending));
}

void RequestDesk::on_mission(const comms::msg::Mission& message) {
  const Key key{message.client(), message.id()};
  if (is_known(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  pending->mission = std::make_unique<control::Mission>();
  const comms::Fault fault = comms::from_message(message, *pending->mission);
  const control::Outcome outcome = fault ? refusal(fault) : control::check(*pending->mission, limits_);
  if (!outcome.accepted) return refuse(key, control::RequestKind::kMission, outcome);
  std::tie(pending->client, pending->id) = key;
  pending->request.kind = control::RequestKind::kMission;
  pending->request.mission = pending->mission.get();
  submit(std::move(pending));
}

void RequestDesk::on_trajectory(const comms::msg::Trajectory& message) {
  const Key key{message.client(), message.id()};
  if (is_known(key)) return;
  auto pending = std::make_unique<PendingRequest>();
  pending->trajectory = std::make_unique<control::Trajectory>();
  const comms::Fault fault = comms::from_message(message, *pending->trajectory);
  const control::Outcome outcome = fault ? refusal(fault) : control::check(*pending->trajectory, limits_);
  if (!outcome.accepted) return refuse(key, control::RequestKind::kTrajectory, outcome);
  std::tie(pending->client, pending->id) = key;
  pending->request.kind = control::RequestKind::kTrajectory;
  pending->request.trajectory = pending->trajectory.get();
  submit(std::move(pending));
}

bool RequestDesk::is_known(const Key& key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto given = answers_.find(key);
  if (given == answers_.end()) return pending_.count(key) > 0;
  outbox_.push_back(given->second);
  outbox_.back().repeated = true;
  wake_.post();
  return true;
}

void RequestDesk::submit(std::unique_ptr<PendingRequest> pending) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const Key key{pending->client, pending->id};
  if (pending_.size() >= kMaxPendingRequests) {
    return settle(key, pending->request.kind,
                  control::refuse("%d requests are under way, no more fit", kMaxPendingRequests));
  }
  pending->asked_ns = runtime::monotonic_ns();
  loop_.requests.push(pending.get());  // fits: no more are under way
  pending_[key] = std::move(pending);
}

void RequestDesk::refuse(const Key& key, control::RequestKind kind, const control::Outcome& outcome) {
  const std::lock_guard<std::mutex> lock(mutex_);
  settle(key, kind, outcome);
}

// With the lock held.
void RequestDesk::settle(const Key& key, control::RequestKind kind, const control::Outcome& outcome) {
  const RequestAnswer answer{key.first, key.second, name_of(kind), outcome, false};
  answers_[key] = answer;
  oldest_.push_back(key);
  if (oldest_.size() > kRememberedAnswers) {
    answers_.erase(oldest_.front());
    oldest_.pop_front();
  }
  outbox_.push_back(answer);
  wake_.post();
}

std::vector<RequestAnswer> RequestDesk::collect() {
  const std::lock_guard<std::mutex> lock(mutex_);
  PendingRequest* judged = nullptr;
  while (loop_.judged.pop(judged)) {
    const Key key{judged->client, judged->id};
    const auto entry = pending_.find(key);
    const std::unique_ptr<PendingRequest> done = std::move(entry->second);
    pending_.erase(entry);
    if (done->state == PendingRequest::State::kGivenUp) continue;  // answered before
    if (done->outcome.accepted && done->mission) mission_ = std::move(done->mission);
    if (done->outcome.accepted && done->trajectory) trajectory_ = std::move(done->trajectory);
    settle(key, done->request.kind, done->outcome);
  }
  const std::int64_t now_ns = runtime::monotonic_ns();
  for (const auto& [key, pending] : pending_) {
    if (now_ns - pending->asked_ns < kPatienceNs || !pending->claim(PendingRequest::State::kGivenUp))
      continue;
    settle(key, pending->request.kind, control::refuse("no IMU samples arrive: is the vehicle running?"));
  }
  return std::exchange(outbox_, {});
}

}  // namespace swiftlet::services

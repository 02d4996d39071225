// Takes requests in, has them judged by the inner loop and keeps the answers. At a standby's desk they are
// only read: what the active controller accepts and flies is kept, so that it can be gone on with.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/plan_store.hpp"
#include "swiftlet/services/messages/topics.hpp"
#include "swiftlet/services/runtime/semaphore.hpp"

namespace swiftlet::services {

// For the one who asked.
struct RequestResult {
  std::uint64_t client = 0;
  std::uint64_t id = 0;
  const char* kind = "";  // "mission", "arm"
  control::Outcome outcome;
  bool repeated = false;      // it was given before
  std::int64_t stamp_ns = 0;  // of an accepted one: as CommandAck's
};

// Requests are known by client and id: one that was answered is answered alike again and not applied twice;
// one that is under way is not taken in again.
class CommandServer {
 public:
  // wake is posted when there is something to collect.
  CommandServer(InnerLoop& loop, const control::Limits& limits, runtime::Semaphore& wake);

  // By any thread that may take a lock; each message type by one thread at a time. What is wrong in itself is
  // refused here, the rest is for the inner loop to judge.
  void on_command(const comms::msg::Command& message);
  void on_mission(const comms::msg::Mission& message);
  void on_trajectory(const comms::msg::Trajectory& message);

  // The answers to be given. Refuses what the inner loop has not looked at in time, because no IMU sample
  // came; lets go of missions and trajectories that the controller has left. By one thread.
  std::vector<RequestResult> collect();

  // Whether requests are taken in and answered here; they are at first. By any thread.
  void set_active(bool active) { active_.store(active, std::memory_order_relaxed); }
  bool active() const { return active_.load(std::memory_order_relaxed); }

  // What the active controller says: the mission that it keeps, the trajectory that it flies, and what it
  // accepted. By any thread.
  void on_flown_mission(const comms::msg::Mission& message);
  void on_flown_trajectory(const comms::msg::Trajectory& message);
  void follow(FailoverState failover_state);

  // What is kept or flown, for the others to know; id 0 if it is not known here.
  comms::msg::Mission mission(std::uint64_t id);
  comms::msg::Trajectory trajectory(std::uint64_t id);

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;  // client, id

  bool is_known(const Key& key);
  bool is_of_another(const comms::msg::Mission& message);
  void submit(std::unique_ptr<PendingRequest> pending);
  void refuse(const Key& key, control::RequestKind kind, const control::Outcome& outcome);
  void settle(const Key& key, control::RequestKind kind, const control::Outcome& outcome,
              std::int64_t stamp_ns = 0);

  void keep_answer(const Key& key, const RequestResult& answer);

  InnerLoop& loop_;
  std::atomic<bool> active_{true};
  const control::Limits limits_;
  runtime::Semaphore& wake_;

  std::mutex mutex_;  // guards all below; held for moments
  std::map<Key, std::unique_ptr<PendingRequest>> pending_;
  std::map<Key, RequestResult> answers_;
  std::deque<Key> oldest_;  // of answers_
  std::vector<RequestResult> outbox_;
  PlanStore<control::Mission> missions_;
  PlanStore<control::Trajectory> trajectories_;
  std::uint64_t failover_states_ = 0;
};

}  // namespace swiftlet::services

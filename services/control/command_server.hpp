// Receives requests, passes them to the inner loop for evaluation and stores the answers. A standby's command
// server only stores what the active controller accepts and flies, so that the standby can continue it.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "swiftlet/control/types/polynomial.hpp"
#include "swiftlet/control/types/settings.hpp"
#include "swiftlet/plant/model/vehicle.hpp"
#include "swiftlet/services/control/gain_designer.hpp"
#include "swiftlet/services/control/inner_loop.hpp"
#include "swiftlet/services/control/plan_store.hpp"
#include "swiftlet/services/control/semaphore.hpp"
#include "swiftlet/services/messages/topics.hpp"

namespace swiftlet::services {

// Identifies requests by client and id, of all kinds. A request that was answered gets the same answer again and is not
// applied twice. One that is repeated while it is being checked or pending is ignored.
class CommandServer {
 public:
  // Posts `wake` when collect() has something to return.
  CommandServer(InnerLoop& loop, const plant::Vehicle& vehicle, const control::ControlSettings& settings,
                GainDesigner designer, Semaphore& wake);

  // Call from any thread that may lock a mutex; each message type from one thread at a time. Refuses
  // malformed and infeasible requests at once; the inner loop evaluates the others.
  void on_command(const messages::msg::Command& message);
  void on_mission(const messages::msg::Mission& message);
  void on_trajectory(const messages::msg::Trajectory& message);
  // Designs the gains in the calling thread.
  void on_control_settings(const messages::msg::ControlSettings& message);

  // The stop request that waits and that the inner loop cannot evaluate, because IMU samples are missing
  // or not usable; nullopt if there is none. It is accepted; call collect() after it and command rotors off. The inner loop
  // evaluates it with the next IMU sample. imu_age_s: since the last sample, -1 if there was none. stamp_ns:
  // of the last sample.
  std::optional<control::RequestKey> accept_overdue_stop(double imu_age_s, std::int64_t stamp_ns);

  // Returns the answers to publish, which are logged. Refuses requests that the inner loop has not evaluated in time, because
  // no IMU sample arrived; never a stop. Erases missions and trajectories that are no longer in use. Call from
  // one thread.
  std::vector<messages::msg::CommandAck> collect();

  // The gains that the inner loop flies with: changes begin there.
  void set_gains_in_force(const control::ControlGains& gains);

  // Active: accepts and answers requests. Active at construction. Call from any thread.
  void set_active(bool active) { active_.store(active, std::memory_order_relaxed); }
  bool active() const { return active_.load(std::memory_order_relaxed); }

  // A standby's input from the active controller: its mission, its trajectory, and its failover state with
  // the accepted requests. Call from any thread.
  void on_flown_mission(const messages::msg::Mission& message);
  void on_flown_trajectory(const messages::msg::Trajectory& message);
  void follow(FailoverState failover_state);

  // The stored mission or trajectory, to publish to other controllers; its id is 0 if it is not stored here.
  messages::msg::Mission mission(std::uint64_t id);
  messages::msg::Trajectory trajectory(std::uint64_t id);

 private:
  using Key = std::pair<std::uint64_t, std::uint64_t>;  // client, id

  // True for the first request with this key: the caller checks it, then calls submit() or refuse(). Else repeats the
  // answer, if there is one.
  bool claim(const Key& key);
  bool is_of_another(const control::Mission& mission) const;
  // Refuses paths that the rotors cannot fly.
  control::Outcome check_rotors(const char* what,
                                const std::vector<control::PolynomialSegment>& segments) const;
  void submit(std::unique_ptr<PendingRequest> pending);
  void refuse(const Key& key, control::RequestKind kind, const control::Outcome& outcome);
  void settle(const Key& key, control::RequestKind kind, const control::Outcome& outcome,
              std::int64_t stamp_ns = 0);

  void keep_answer(const Key& key, const messages::msg::CommandAck& answer);

  InnerLoop& loop_;
  std::atomic<bool> active_{true};
  const plant::Vehicle vehicle_;
  const control::Limits limits_;
  const double low_battery_voltage_;  // V, at which paths are checked
  const GainDesigner designer_;
  Semaphore& wake_;

  std::mutex mutex_;                                        // guards all members below; held briefly
  std::set<Key> checked_;                                   // between claim() and submit() or refuse()
  std::map<Key, std::unique_ptr<PendingRequest>> pending_;  // the inner loop points to them
  std::map<Key, messages::msg::CommandAck> answers_;
  std::deque<Key> oldest_;  // keys of answers_, oldest first
  std::vector<messages::msg::CommandAck> outbox_;
  PlanStore<control::Mission> missions_;
  PlanStore<control::Trajectory> trajectories_;
  control::ControlGains gains_in_force_;
  std::uint64_t failover_states_ = 0;
};

}  // namespace swiftlet::services

// A vehicle and its controllers, for failover_test.cpp.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

#include "swiftlet/services/control/failover.hpp"

namespace swiftlet::services::failover_test {

constexpr std::int64_t kPeriodNs = 2'000'000;
constexpr std::int64_t kStartNs = 5'000'000'000;  // of the host clock

inline std::int64_t ms(std::int64_t time) { return time * 1'000'000; }

// A vehicle and its controllers on a network without delay. Every controller, active or standby, sends a
// heartbeat with each sample.
class Vehicle {
 public:
  struct Controller {
    Controller(std::uint64_t number, int failover_priority)
        : id(number), n(failover_priority), failover(number, failover_priority) {}
    std::uint64_t id;
    int n;
    Failover failover;
    bool runs = true;  // false: dead or stopped
    bool receives_heartbeats = true;
    bool is_heard = true;       // by the vehicle
    std::int64_t delay_ns = 0;  // of its network, from sample to command
    struct Command {
      std::int64_t arrival_ns, stamp_ns;
      std::uint32_t term;
    };
    std::deque<Command> outbox{};                                     // under way
    std::deque<std::pair<std::int64_t, plant::ObeyedCommand>> inbox;  // samples, by stamp
  };

  Controller& add(std::uint64_t id, int failover_priority) {
    controllers_.push_back(std::make_unique<Controller>(id, failover_priority));
    return *controllers_.back();
  }

  // One that flies, number 7, and its standbys of these priorities, numbers 8 and up.
  std::vector<Controller*> fly_with_standbys(std::initializer_list<int> priorities) {
    std::vector<Controller*> all{&add(7, 5)};
    run(300);
    for (const int priority : priorities) all.push_back(&add(7 + all.size(), priority));
    run(1000);
    return all;
  }

  void run(std::int64_t duration_ms) {
    for (std::int64_t i = 0; i < ms(duration_ms) / kPeriodNs; ++i) sample();
  }

  void sample() {
    stamp_ns_ += kPeriodNs;
    now_ns_ += kPeriodNs;
    for (const auto& c : controllers_)
      c->inbox.emplace_back(stamp_ns_, reports_ ? obeyed_ : plant::ObeyedCommand());
    for (const auto& c : controllers_) {
      if (c->runs) answer(*c);
    }
    for (const auto& c : controllers_) {
      for (; !c->outbox.empty() && c->outbox.front().arrival_ns <= stamp_ns_; c->outbox.pop_front())
        command(*c, c->outbox.front());
    }
  }

  void answer(Controller& c) {
    while (!c.inbox.empty()) {
      const auto [stamp_ns, obeyed] = c.inbox.front();
      c.inbox.pop_front();
      const Role role = c.failover.sample(stamp_ns, obeyed, now_ns_);
      if (role == Role::kActive) c.outbox.push_back({stamp_ns + c.delay_ns, stamp_ns, c.failover.term()});
      for (const auto& other : controllers_) {
        if (other.get() != &c && other->runs && other->receives_heartbeats && c.receives_heartbeats)
          other->failover.heard({c.id, c.n, c.failover.term(), role, now_ns_});
      }
    }
  }

  // As in the vehicle's watchdog.
  void command(const Controller& c, const Controller::Command& command) {
    if (!obeys_ || !c.is_heard || (obeyed_.any && command.stamp_ns < obeyed_.stamp_ns)) return;
    if (obeyed_.any && command.term < obeyed_.term && stamp_ns_ - obeyed_.stamp_ns < ms(200)) {
      ++refused_;
      return;
    }
    if (obeyed_.any) longest_gap_ns_ = std::max(longest_gap_ns_, stamp_ns_ - obeyed_.stamp_ns);
    if (commander_ != c.id) ++changes_;
    commander_ = c.id;
    obeyed_ = {true, true, command.term, command.stamp_ns};
  }

  void restart() {
    stamp_ns_ = 0;
    obeyed_ = {true, false, 0, 0};
    longest_gap_ns_ = 0;
  }
  void stop_reporting() { reports_ = false; }
  void obey(bool obeys) { obeys_ = obeys; }

  const std::vector<std::unique_ptr<Controller>>& controllers() const { return controllers_; }
  int active() const {
    return static_cast<int>(std::count_if(controllers_.begin(), controllers_.end(), [](const auto& c) {
      return c->runs && c->failover.role() == Role::kActive;
    }));
  }
  std::uint64_t commander() const { return commander_; }
  std::int64_t longest_gap_ns() const { return longest_gap_ns_; }
  int changes() const { return changes_; }
  int refused() const { return refused_; }

 private:
  std::int64_t stamp_ns_ = 0;
  std::int64_t now_ns_ = kStartNs;
  bool reports_ = true;
  bool obeys_ = true;
  plant::ObeyedCommand obeyed_{true, false, 0, 0};
  std::uint64_t commander_ = 0;
  std::int64_t longest_gap_ns_ = 0;
  int changes_ = 0;
  int refused_ = 0;
  std::vector<std::unique_ptr<Controller>> controllers_;
};

}  // namespace swiftlet::services::failover_test

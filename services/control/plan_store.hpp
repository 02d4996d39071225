// Stores the missions or trajectories that this process knows. The inner loop flies one of them by address,
// so none is erased while the inner loop may use it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <utility>

namespace swiftlet::services {

template <class Plan>
class PlanStore {
 public:
  // The newest plan of this id, or null.
  const Plan* find(std::uint64_t id) const {
    const auto entry =
        std::find_if(entries_.rbegin(), entries_.rend(), [id](const Entry& e) { return e.plan->id == id; });
    return entry == entries_.rend() ? nullptr : entry->plan.get();
  }

  void put(std::unique_ptr<Plan> plan) { entries_.push_back({std::move(plan), 0}); }

  // Stores an accepted plan: it stays in use until another one is accepted.
  void put_flown(std::unique_ptr<Plan> plan) {
    flown_ = plan.get();
    put(std::move(plan));
  }

  // Marks the plan as passed to the inner loop with the FailoverState of this number. plan may be null.
  void lend(const Plan* plan, std::uint64_t failover_state) {
    for (Entry& entry : entries_) {
      if (entry.plan.get() == plan) entry.failover_state = failover_state;
    }
  }

  // Erases the oldest plans beyond the capacity that the inner loop cannot use. adopted: number of the newest
  // FailoverState that the inner loop has adopted.
  void tidy(std::uint64_t adopted) {
    const auto idle = [&](const Entry& e) {
      return e.plan.get() != flown_ && (e.failover_state == 0 || e.failover_state < adopted);
    };
    while (entries_.size() > kCapacity) {
      const auto entry = std::find_if(entries_.begin(), entries_.end(), idle);
      if (entry == entries_.end()) return;
      entries_.erase(entry);
    }
  }

  std::size_t size() const { return entries_.size(); }
  static constexpr std::size_t kCapacity = 4;

 private:
  struct Entry {
    std::unique_ptr<Plan> plan;
    std::uint64_t failover_state = 0;  // number of the last one that passed it on; 0: none
  };
  std::deque<Entry> entries_;  // oldest first
  const Plan* flown_ = nullptr;
};

}  // namespace swiftlet::services

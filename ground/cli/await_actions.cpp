#include "swiftlet/ground/cli/await_actions.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <unistd.h>

#include <fmt/core.h>

#include "swiftlet/ground/terminal/fleet_progress.hpp"
#include "swiftlet/ground/terminal/mission_progress.hpp"

namespace swiftlet::ground {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kAwaitStep{50};
constexpr std::chrono::milliseconds kLeastStep{1};
constexpr auto kRestTimeout = 1s;   // for the answer to a request after an interrupt signal
constexpr auto kQuietTime = 10s;    // without a terminal, shorter actions show no progress
constexpr int kAttemptsToHold = 3;  // a vehicle may lift off or touch down between two attempts

std::string progress_text(const std::string& what, double progress, const VehicleState& state) {
  if (state.mode == control::Mode::kMission) return mission_progress_text(state);
  return fmt::format("{} {:3.0f} %  {}", what, 100.0 * progress, state_text(state));
}

int stage_of(const VehicleState& state) {
  return state.mode == control::Mode::kMission ? state.mission.item : 0;
}

std::vector<std::string> names_of(const std::vector<AwaitedAction>& actions) {
  std::vector<std::string> names;
  names.reserve(actions.size());
  for (const AwaitedAction& action : actions) names.push_back(action.vehicle->name());
  return names;
}

class Wait {
 public:
  Wait(const std::vector<AwaitedAction>& actions, const std::string& what, std::optional<double> limit_s)
      : actions_(actions),
        what_(what),
        results_(actions.size()),
        step_(std::max(kAwaitStep / std::max(static_cast<int>(actions.size()), 1), kLeastStep)),
        limit_s_(limit_s),
        progress_(line_, names_of(actions)) {}

  std::vector<ActionResult> run(OnInterrupt on_interrupt, const Interrupts& interrupts) {
    while (!step()) {
      if (interrupts.count() > 0) {
        rest_all(on_interrupt);
      } else if (limit_s_ && waited_s() >= *limit_s_) {
        end_all({ActionResult::Kind::kTimedOut, fmt::format("not done after {:.1f} s", *limit_s_)});
      }
    }
    std::vector<ActionResult> results;
    for (const std::optional<ActionResult>& result : results_) results.push_back(*result);
    return results;
  }

 private:
  double waited_s() const { return std::chrono::duration<double>(Clock::now() - begin_).count(); }

  // Waits for a moment. Returns true if all actions have ended.
  bool step() {
    bool all = true;
    for (std::size_t i = 0; i < actions_.size(); ++i) {
      if (results_[i]) continue;
      const ActionResult result = actions_[i].action.wait(step_);
      if (result.kind != ActionResult::Kind::kTimedOut) {
        results_[i] = result;
        continue;
      }
      all = false;
      show(i);
    }
    return all;
  }

  void show(std::size_t i) {
    const VehicleState state = actions_[i].vehicle->state();
    const int stage = stage_of(state);
    if (isatty(STDERR_FILENO) == 0 && stage == 0 && Clock::now() - begin_ < kQuietTime) return;
    progress_.of(i).update(stage, progress_text(what_, actions_[i].action.progress(), state));
  }

  void end_all(const ActionResult& result) {
    for (std::optional<ActionResult>& one : results_) {
      if (!one) one = result;
    }
  }

  void rest_all(OnInterrupt on_interrupt) {
    std::vector<std::future<void>> resting;
    for (std::size_t i = 0; i < actions_.size(); ++i) {
      if (results_[i]) continue;
      resting.push_back(std::async(std::launch::async, [this, i, on_interrupt] {
        results_[i] = {ActionResult::Kind::kTimedOut,
                       rest_after_interrupt(*actions_[i].vehicle, on_interrupt)};
      }));
    }
  }

  const std::vector<AwaitedAction>& actions_;
  const std::string& what_;
  std::vector<std::optional<ActionResult>> results_;
  std::chrono::milliseconds step_;  // of each action
  std::optional<double> limit_s_;
  Clock::time_point begin_ = Clock::now();
  io::ProgressLine line_;
  FleetProgress progress_;
};

}  // namespace

std::vector<ActionResult> await_actions(const std::vector<AwaitedAction>& actions, const std::string& what,
                                        OnInterrupt on_interrupt, const Interrupts& interrupts,
                                        std::optional<double> limit_s) {
  return Wait(actions, what, limit_s).run(on_interrupt, interrupts);
}

std::string rest_after_interrupt(Vehicle& vehicle, OnInterrupt on_interrupt) {
  const std::string& name = vehicle.name();
  if (on_interrupt == OnInterrupt::kNothing) return "interrupted";
  if (!vehicle.connected())
    return "interrupted; " + name + " was NOT told to hold: its control service is silent";
  vehicle.cancel_when({});
  if (on_interrupt == OnInterrupt::kPauseMission && vehicle.pause_mission(0, kRestTimeout).accepted())
    return "interrupted; " + name + " paused the mission and holds; `swiftlet mission resume` continues";
  std::string reason;
  for (int attempt = 0; attempt < kAttemptsToHold; ++attempt) {
    const Result held = vehicle.hold(kRestTimeout).answer();
    if (held.accepted()) return "interrupted; " + name + " holds";
    if (vehicle.disarm(kRestTimeout).accepted()) return "interrupted; " + name + " is disarmed";
    reason = held.reason;
  }
  return "interrupted; " + name + " does NOT hold: " + reason;
}

}  // namespace swiftlet::ground

// Waits at the terminal until the actions of one or several vehicles end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/action.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/flight/interrupts.hpp"

namespace swiftlet::ground {

// What an interrupt signal (Ctrl-C) requests of a vehicle whose action has not ended.
enum class OnInterrupt {
  kHold,          // in the air; on the ground, a vehicle that is armed is disarmed
  kPauseMission,  // if it cannot be paused, as kHold
  kNothing,
};

struct AwaitedAction {
  Vehicle* vehicle = nullptr;
  ActionHandle action;
};

// Waits until each action ends, at most limit_s, and returns the results in the same order. Shows the progress
// on standard error: `what`, the share that is done, mode and position. An interrupt signal ends the wait; the
// result is then kTimedOut, and its reason says what the vehicle does now.
std::vector<ActionResult> await_actions(const std::vector<AwaitedAction>& actions, const std::string& what,
                                        OnInterrupt on_interrupt, const Interrupts& interrupts,
                                        std::optional<double> limit_s);

// Requests what `on_interrupt` says. Returns "interrupted; " and what the vehicle does now.
std::string rest_after_interrupt(Vehicle& vehicle, OnInterrupt on_interrupt);

}  // namespace swiftlet::ground

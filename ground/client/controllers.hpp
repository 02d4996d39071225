// The controllers of a vehicle that are alive.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "swiftlet/ground/client/client.hpp"

namespace swiftlet::ground {

struct LiveController {
  std::uint64_t number = 0;
  bool active = false;
  std::shared_ptr<const msg::ControllerState> state{};  // null while it answers no IMU samples
};

struct LiveControllers {
  std::vector<LiveController> known;  // the active one first, then by descending failover priority
  int others = 0;                     // processes that announce themselves as control, and no more

  int count() const { return static_cast<int>(known.size()) + others; }
};

// Needs Client::hear_controllers(). Controllers publish their state with IMU samples only: while these are
// missing, control_status shows the active one, and discovery how many there are.
LiveControllers controllers_of(const View& view, Clock::time_point now);

}  // namespace swiftlet::ground

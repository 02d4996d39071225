// Keeps the vehicles of a fleet apart in a flight in real time: hears their estimates, asks the monitor
// (ground/fleet/fleet_monitor.hpp), and pauses, resumes or moves missions.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "swiftlet/ground/fleet/order_sender.hpp"
#include "swiftlet/io/command_line/progress.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"

namespace swiftlet::ground {

struct WatchedVehicle {
  std::shared_ptr<Client> client;
  io::Progress* progress = nullptr;  // outlives the watch
};

// Begins when a mission runs, and ends when it is destroyed. A mission that another tool has paused is left
// paused. Each vehicle is asked from a thread of its own: one that does not answer delays no other.
class FleetWatch {
 public:
  // vehicles: in the order of the monitor's. gives_up: true from when the flight is abandoned, and all are
  // landed: nothing else is sent from then on. Called from several threads.
  FleetWatch(FleetMonitor monitor, std::vector<WatchedVehicle> vehicles, std::function<bool()> gives_up);

 private:
  void step();

  FleetMonitor monitor_;
  std::vector<WatchedVehicle> vehicles_;
  const std::function<bool()> gives_up_;
  std::deque<OrderSender> senders_;
  std::optional<Clock::time_point> start_;
  dds::PeriodicTask task_;  // last: uses all members above
};

}  // namespace swiftlet::ground

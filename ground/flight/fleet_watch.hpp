// Keeps the vehicles of a fleet apart in a flight in real time: hears their estimates, asks the monitor
// (ground/fleet/fleet_monitor.hpp), and pauses, resumes or moves missions.
#pragma once

#include <optional>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/ground/fleet/fleet_monitor.hpp"
#include "swiftlet/ground/terminal/progress.hpp"
#include "swiftlet/services/dds/periodic_task.hpp"

namespace swiftlet::ground {

// Begins when a mission runs, and ends when it is destroyed. A mission that another tool has paused is left paused.
class FleetWatch {
 public:
  struct Watched {
    Client* client = nullptr;      // outlives this object
    Progress* progress = nullptr;  // likewise
  };

  // vehicles: in the order of the monitor's.
  FleetWatch(FleetMonitor monitor, std::vector<Watched> vehicles);

 private:
  void step();
  VehicleNews news_of(std::size_t i, const View& view, Clock::time_point now) const;
  void carry_out(std::size_t i, const Order& order, const View& view);

  FleetMonitor monitor_;
  std::vector<Watched> vehicles_;
  std::vector<Order> carried_out_;  // the last order that each vehicle has accepted
  std::optional<Clock::time_point> start_;
  comms::PeriodicTask task_;  // last: uses all members above
};

}  // namespace swiftlet::ground

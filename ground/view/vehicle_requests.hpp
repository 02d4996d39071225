// The requests that a viewer can send to a vehicle, as services: hold, land and stop.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "swiftlet/ground/client/context.hpp"
#include "swiftlet/ground/client/vehicle.hpp"
#include "swiftlet/ground/view/foxglove.hpp"

namespace swiftlet::ground {

// From one thread.
class VehicleRequests {
 public:
  static constexpr std::size_t kMostUnderWay = 64;  // of holds, of landings and of stops

  explicit VehicleRequests(const Context& context) : context_(context) {}
  // Waits for those under way, which it cancels.
  ~VehicleRequests();
  VehicleRequests(const VehicleRequests&) = delete;
  VehicleRequests& operator=(const VehicleRequests&) = delete;

  // Adds the services of a vehicle: /kl1/hold and /kl1/land (std_srvs/srv/Trigger), and /kl1/stop (std_srvs/srv/SetBool,
  // with true as the confirmation). Throws std::runtime_error.
  void add_vehicle(const std::string& name);
  // With ids from 0 in this order.
  const std::vector<foxglove::Service>& services() const { return services_; }

  struct Answer {
    bool accepted = false;
    std::string reason;  // why the vehicle refused it, or what to know about an accepted one; may be empty
  };
  // Sends the request in a thread of its own, which then calls done once. Returns why that was not done: a sentence,
  // empty if it was.
  std::string call(const foxglove::ServiceCall& call, std::function<void(const Answer&)> done);

 private:
  const Context& context_;
  std::atomic<bool> ending_{false};
  std::vector<foxglove::Service> services_;
  std::vector<std::unique_ptr<Vehicle>> vehicles_;
  std::array<std::list<std::future<void>>, 3> under_way_;  // by kind; last: they use the vehicles
};

// The answer as the response of a service: bool success, string message.
mcap::Bytes to_response(const VehicleRequests::Answer& answer);

}  // namespace swiftlet::ground

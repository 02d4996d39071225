// A vehicle with redundant controllers, each a process that can be killed, and metrics of the flight
// meanwhile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/support/flight_samples.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::tests {

constexpr std::int64_t kSecond = 1'000'000'000;  // ns

// What a takeover may cost, with security and without; `./dev soak standby` judges by the same.
constexpr double kLongestGap_ms = 60.0;
constexpr double kLargestDeviation_m = 0.05;

// One controller process.
struct Controller {
  std::unique_ptr<Program> process;
  std::uint64_t id = 0;  // as in controller_state
  int failover_priority = 0;
};

class RedundantFlight {
 public:
  // Starts plant and mocap. Programs write their output into the folder. network: key and security of all.
  // Without options by the wall clock; simulated_time.hpp has those for simulated time.
  explicit RedundantFlight(const std::filesystem::path& folder,
                           const std::vector<std::string>& plant_options = {},
                           const dds::NodeSettings& network = {},
                           const std::vector<std::string>& mocap_options = {});

  // Starts a controller and waits for its state. Throws std::runtime_error if none arrives.
  Controller& start_controller(int failover_priority);
  // Starts a controller without waiting.
  std::unique_ptr<Program> launch_controller(int failover_priority) const;
  // The active controller; throws std::runtime_error unless exactly one of those started here is active.
  Controller& active();
  void kill(Controller& controller);
  // Suspends and resumes the plant's process: vehicle time stands still in between.
  void stop_time();
  void resume_time();
  const std::vector<std::unique_ptr<Controller>>& controllers() const { return controllers_; }
  const Program& plant() const { return plant_; }
  const Program& mocap() const { return mocap_; }

  // By the controller_state messages of the last 0.5 s.
  int active_count() const;
  int standby_count() const;
  std::map<std::uint64_t, messages::msg::ControllerState> recent_states() const;

  // Waits for the predicate; throws std::runtime_error with `what` after 30 s.
  void wait(const char* what, const std::function<bool()>& predicate) const;
  void wait_for_roles(int active, int standby) const;  // all of them ready

  // Arms, uploads and starts the mission; throws std::runtime_error with the reason of a refusal.
  void fly(const control::Mission& mission);
  void ask(control::RequestKind kind, double z_ned = 0.0);
  ground::Client& client() { return client_; }
  std::vector<std::string> network() const;  // as command line arguments
  std::vector<std::string> on_network(std::vector<std::string> words) const;
  dds::NodeSettings node_settings(const char* name) const;

  // Stamp, speed and height of the vehicle's newest sample.
  std::int64_t stamp_ns() const { return samples_.stamp_ns(); }
  double speed() const { return samples_.speed(); }  // m/s
  double z_ned() const { return samples_.z_ned(); }  // m
  // Metrics between two stamps; waits for the second. period_ns: of a repeating path, 0 if none.
  FlightMetrics metrics(std::int64_t from_ns, std::int64_t to_ns, std::int64_t period_ns = 0) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  struct ReceivedState {
    messages::msg::ControllerState message;
    ground::Clock::time_point at;
  };

  std::set<std::uint64_t> known_ids() const;  // of all controllers that were ever heard
  int count(std::uint8_t role) const;

  dds::DomainLock lock_;
  std::filesystem::path folder_;
  const std::string network_key_file_;
  const std::string security_;
  Program plant_, mocap_;
  std::vector<std::unique_ptr<Controller>> controllers_;

  mutable std::mutex mutex_;                       // guards states_
  std::map<std::uint64_t, ReceivedState> states_;  // by controller

  ground::Client client_;
  dds::Node node_;
  FlightSamples samples_;
  dds::Subscription controller_states_;  // last: its callback uses the members above
};

}  // namespace swiftlet::tests

// A vehicle that several controllers fly, each a process that can be killed, and an observer of what that
// does to the flight.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "swiftlet/ground/client/client.hpp"
#include "swiftlet/services/dds/discovery/domain_lock.hpp"
#include "swiftlet/services/dds/node.hpp"
#include "tests/integration/program.hpp"

namespace swiftlet::tests {

// One of the controllers.
struct Controller {
  std::unique_ptr<Program> process;
  std::uint64_t id = 0;  // as in controller_state
  int failover_priority = 0;
};

// What the vehicle felt of a while.
struct Felt {
  double longest_gap_ms = 0.0;       // that no command was newer, on the vehicle's clock
  double largest_deviation_m = 0.0;  // of the true place from the reference
  double extra_deviation_m = 0.0;    // beyond that of the period before, at the same place of the pattern
  double largest_step_m = 0.0;  // of the reference, beside what its velocity makes of the time that passed
  int changes_of_controller = 0;
  double lowest_z_ned = 0.0;  // m; z points down
  std::size_t samples = 0;
};

class RedundantFlight {
 public:
  // Starts plant and mocap. Programs write their output into the folder.
  explicit RedundantFlight(const std::filesystem::path& folder, std::vector<std::string> plant_options = {});

  // Starts a controller and waits until it is heard. Throws std::runtime_error if it is not.
  Controller& start_controller(int failover_priority);
  // Starts one without waiting.
  std::unique_ptr<Program> launch_controller(int failover_priority) const;
  // The one that acts; throws std::runtime_error if it is none of them, or not one.
  Controller& active();
  void kill(Controller& controller);
  // Stops the plant's process and lets it go on: no time of the vehicle passes between the two.
  void stop_time();
  void resume_time();
  const std::vector<std::unique_ptr<Controller>>& controllers() const { return controllers_; }

  // As controller_state has it of those heard within the last half second.
  int active_count() const;
  int standby_count() const;
  std::map<std::uint64_t, comms::msg::ControllerState> heard() const;

  // Until it holds; throws std::runtime_error that names it if it does not within 30 s.
  void wait(const char* what, const std::function<bool()>& predicate) const;
  void wait_for_roles(int active, int standby) const;  // and until all are ready

  // Arms and uploads; throws std::runtime_error with the reason of a refusal.
  void fly(const control::Mission& mission);
  void ask(std::uint8_t kind, double z_ned = 0.0);
  ground::Client& client() { return client_; }
  std::vector<std::string> network() const;  // as words of a command line
  comms::NodeSettings node_settings(const char* name) const;

  // The newest of the vehicle's samples.
  std::int64_t stamp_ns() const;
  double speed() const;  // m/s
  double z_ned() const;  // m
  // Between two stamps; waits for the second. period_ns: after which the path repeats itself; 0: it does not.
  Felt felt(std::int64_t from_ns, std::int64_t to_ns, std::int64_t period_ns = 0) const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  struct Truth {
    std::array<double, 3> position_ned{};
    double speed = 0.0;
  };
  struct Heard {
    comms::msg::ControllerState message;
    ground::Clock::time_point at;
  };

  int count(std::uint8_t role) const;
  std::optional<double> deviation_m(std::int64_t stamp_ns) const;  // with the lock held

  comms::DomainLock lock_;
  std::filesystem::path folder_;
  Program plant_, mocap_;
  std::vector<std::unique_ptr<Controller>> controllers_;

  mutable std::mutex mutex_;                     // guards all up to client_
  std::map<std::int64_t, comms::msg::Imu> imu_;  // by stamp
  std::map<std::int64_t, Truth> truth_;
  std::map<std::int64_t, comms::msg::Reference> reference_;
  std::map<std::uint64_t, Heard> heard_;  // by controller

  ground::Client client_;
  comms::Node node_;
  std::vector<comms::Subscription> subscriptions_;  // last: their callbacks use what stands above
};

// Laps of a square with sides of 2 m at 1 m height, straight up first and down last. One side is flown as the
// next, in side_ns(speed).
control::Mission square_laps(double speed, int laps);
std::int64_t side_ns(double speed);

}  // namespace swiftlet::tests

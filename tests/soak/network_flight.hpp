// A flight over several hosts on a switch: plant, motion capture (on the host of the plant or its own), control, ground.
// Needs root.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/network/network_namespace.hpp"
#include "tests/support/program.hpp"

namespace swiftlet::soak {

class NetworkFlight {
 public:
  enum Host { kVehicle, kControl, kGround, kMocap, kHosts };

  struct Result {
    bool completed = false;
    std::string fault;   // what failed, as the tool says it
    double rms_m = 0.0;  // of the true position from the reference
    double peak_m = 0.0;
    double longest_gap_s = 0.0;  // of the telemetry on the ground
    std::uint64_t refused = 0;   // datagrams, all of which are of its own processes
  };

  // The hosts; nothing runs yet. Programs write their output into the folder. Throws std::runtime_error if the hosts
  // cannot be made.
  explicit NetworkFlight(std::filesystem::path folder);

  const tests::HostNetwork& network() const { return network_; }

  // Plant, motion capture and control. seed: of the simulation. mocap: the host of motion capture.
  void start(std::uint64_t seed, const std::vector<std::string>& control_options = {}, Host mocap = kVehicle);
  // One more controller, on the host of the vehicle. Stays valid.
  tests::Program& start_standby();
  // What all programs have logged.
  std::string log() const;
  // Runs a command of `swiftlet` on the ground.
  tests::ProgramResult ground(const std::vector<std::string>& words, std::chrono::seconds timeout) const;
  // With `swiftlet fly --attach`, to its end. mission: file, or name in config/missions.
  Result fly(const std::string& mission) const;

 private:
  tests::Program& run(Host host, const char* program, const std::vector<std::string>& options);

  const std::filesystem::path folder_;
  const tests::HostNetwork network_;
  std::deque<tests::Program> programs_;
};

}  // namespace swiftlet::soak

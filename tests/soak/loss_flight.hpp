// A flight over three hosts on a switch that lose datagrams: plant and motion capture, control, ground. Needs root.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "tests/soak/network_flight.hpp"

namespace swiftlet::soak {

// Frames of IPv4 that each host loses of those that it sends, and of those that it receives, at random and independently:
// at the hooks egress and ingress of its Ethernet interface. Between two hosts 1 - (1 - p)^2 are lost. Each fragment of a
// large datagram is a frame.
struct LossSettings {
  int percent = 30;
  std::uint64_t seed = 1;          // of the simulation and the waypoints; the losses cannot be repeated
  int waypoints = 1000;            // of the mission that is uploaded and deleted before the flight
  std::string mission = "square";  // file, or name in config/missions
};

struct LossResult {
  double upload_s = 0.0;  // from the start of the tool, with its discovery; negative if it failed
  double clear_s = 0.0;   // likewise
  std::string fault;      // what failed, as the tools say it
  NetworkFlight::Result flight;

  bool good() const;
};

// The limit of the tracking error's root mean square. `fly` itself limits the peak by the mission's tolerance.
constexpr double kLargestRms_m = 0.005;

// Starts the processes and lets them discover each other while datagrams are lost. Programs write their output into the
// folder. Throws std::runtime_error if the hosts cannot be made.
LossResult fly_with_losses(const LossSettings& settings, const std::filesystem::path& folder);

}  // namespace swiftlet::soak

// Measures the network between the hosts of a domain: probes by multicast and unicast, which the probes of the other
// hosts answer. They use two UDP ports of the domain that DDS leaves free, and the multicast address of DDS.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace swiftlet::ground {

// UDP ports of a domain, next to those of DDS.
constexpr int probe_multicast_port(int domain) { return 7408 + 250 * domain; }
constexpr int probe_port(int domain) { return 7409 + 250 * domain; }

// Another host on which a probe runs.
struct ProbedHost {
  std::string name;
  std::string address;
  bool multicast_heard = false;     // its multicast reaches this host
  bool multicast_answered = false;  // that of this host reaches it
  int sent = 0;                     // unicast probes
  int answered = 0;
  double round_trip_min_ms = 0.0;
  double round_trip_median_ms = 0.0;
  double round_trip_max_ms = 0.0;
  // Its system clock minus that of this host at the end, and how wrong that may be (clock_filter.hpp).
  double clock_offset_ms = 0.0;
  double clock_uncertainty_ms = 0.0;
  // How fast it is against the monotonic clock of this host, and twice its standard deviation.
  double clock_drift_ppm = 0.0;
  double clock_drift_uncertainty_ppm = 0.0;
  int clock_steps = 0;  // while it was measured
};

struct ProbeReport {
  // Addresses on which this host heard its own multicast.
  std::vector<std::string> own_multicast;
  std::vector<ProbedHost> hosts;
  std::vector<std::string> silent_peers;  // addresses that were asked to and did not answer
};

class NetworkProbe {
 public:
  // addresses: IPv4 addresses of this host. peers: IPv4 addresses that it also asks by unicast. Throws
  // std::runtime_error if the ports cannot be opened, as by a second probe of this host.
  NetworkProbe(int domain, const std::vector<std::string>& addresses, const std::vector<std::string>& peers);
  ~NetworkProbe();
  NetworkProbe(const NetworkProbe&) = delete;
  NetworkProbe& operator=(const NetworkProbe&) = delete;

  // Sends probes every 50 ms for this time, answers those of others, and then waits for the last answers.
  ProbeReport run(std::chrono::milliseconds time);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace swiftlet::ground

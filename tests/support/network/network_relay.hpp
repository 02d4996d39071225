// Takes the place of a cable between a host and the switch, and treats its frames as a bad network does.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>

#include "tests/support/network/network_namespace.hpp"

namespace swiftlet::tests {

// What befalls each frame, in each direction, at random and independently.
struct CableConditions {
  double delay_s = 0.0;
  double jitter_s = 0.0;    // added to the delay, or taken from it, at most; frames overtake each other
  double duplicated = 0.0;  // share of the frames that arrive twice, the second one later by up to the jitter
  std::uint64_t seed = 1;
};

// For HostNetwork::Layout::kSwitch, as root. One thread moves the frames, in time to within some 0.1 ms.
class NetworkRelay {
 public:
  // Throws std::runtime_error with what failed.
  NetworkRelay(const HostNetwork& network, int host, const CableConditions& conditions);
  ~NetworkRelay();
  NetworkRelay(const NetworkRelay&) = delete;
  NetworkRelay& operator=(const NetworkRelay&) = delete;

  // From the next frame on, no frame of IPv4 from or to that host passes for this time, or until unblock().
  void block(const std::string& address, std::chrono::milliseconds duration);
  void unblock() { blocked_ = 0; }
  bool blocked() const { return blocked_ != 0; }

  std::uint64_t overtaken() const { return overtaken_; }    // frames that arrived before an earlier one
  std::uint64_t duplicated() const { return duplicated_; }  // frames

 private:
  class Cable;
  void run(int host_end, int switch_end);

  const CableConditions conditions_;
  std::atomic<std::uint32_t> blocked_{0};  // IPv4 address as on the wire; 0: none
  std::atomic<std::chrono::milliseconds> blocked_for_{};
  std::atomic<std::uint64_t> overtaken_{0};
  std::atomic<std::uint64_t> duplicated_{0};
  std::atomic<bool> stop_{false};
  int host_end_ = -1;
  int switch_end_ = -1;
  std::thread thread_;
};

}  // namespace swiftlet::tests

// How a standby took over, and where the time went: for the log.
#pragma once

#include <cstdint>
#include <string>

namespace swiftlet::services {

// On the vehicle's clock, ns. Silence: the age of the last command that the vehicle obeyed; if it does not report that, the
// time since a heartbeat of the active controller.
struct Takeover {
  std::int64_t silence_ns = 0;          // in the sample with which the standby took over
  std::int64_t patience_ns = 0;         // for which it waited
  std::int64_t delay_p95_ns = -1;       // which 95 % of the commands needed; -1: not known
  int rank = 0;                         // of the standby; 0: the first
  bool continues = false;               // it knew the state of the flight
  std::int64_t longest_silence_ns = 0;  // until the vehicle obeyed
  std::int64_t longest_pause_ns =
      0;                // between two samples in these, monotonic: vehicle, network or standby stood still
  bool obeyed = false;  // by the vehicle; false: not reported, or not within half a second
};

// A sentence for the log.
std::string to_string(const Takeover& takeover);

}  // namespace swiftlet::services

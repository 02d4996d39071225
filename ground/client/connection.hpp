// Connection events of a Vehicle: its control process is found, lost or replaced.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace swiftlet::ground {

// Without control_status, which has 10 Hz, for this long, the control process counts as disconnected.
constexpr std::chrono::milliseconds kConnectionSilence{1000};

struct ConnectionEvent {
  enum class Kind {
    kConnected,  // control_status is received, for the first time or again
    kLost,       // no control_status for kConnectionSilence
    kReplaced,   // another process controls the vehicle: restarted, or a standby took over
  };
  Kind kind = Kind::kLost;
  std::uint64_t controller = 0;  // random number of the current or last process
  std::string text;              // a sentence
};

}  // namespace swiftlet::ground

// What a Vehicle tells of its control process.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace swiftlet::ground {

// control_status comes ten times a second: this long without one, nobody is connected.
constexpr std::chrono::milliseconds kConnectionSilence{1000};

struct ConnectionEvent {
  enum class Kind {
    kConnected,  // it is heard, for the first time or again
    kLost,       // it has fallen silent
    kReplaced,  // another process controls the vehicle: the old one was started again, or a standby took over
  };
  Kind kind = Kind::kLost;
  std::uint64_t controller = 0;  // the random number of the process that is heard, or was
  std::string text;              // a sentence
};

}  // namespace swiftlet::ground

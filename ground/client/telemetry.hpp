// Which messages of a vehicle a client receives.
#pragma once

namespace swiftlet::ground {

enum class Telemetry {
  kReceived,     // all
  kNotReceived,  // those at 10 Hz at most: enough to send requests, at less processor time
};

}  // namespace swiftlet::ground

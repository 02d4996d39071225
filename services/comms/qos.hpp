// The four ways in which topics are delivered.
#pragma once

namespace swiftlet::comms {

enum class Qos {
  kStream,       // best effort, keep last 1, volatile, deadline, preallocated
  kOwnedStream,  // a stream of which the strongest living writer is heard (exclusive ownership)
  kTelemetry,    // best effort, keep last 1, volatile
  kState,        // reliable, transient local, keep last 1
  kRequest,      // reliable, volatile, keep all within limits
};

}  // namespace swiftlet::comms

// The QoS profiles of the topics, and their parameters. idl/README.md shows them as a table.
#pragma once

#include <chrono>

namespace swiftlet::messages {

enum class Qos {
  kStream,        // best effort, keep last 1, volatile, preallocated
  kTelemetry,     // best effort, keep last 1, volatile
  kLatched,       // reliable, transient local, keep last 1
  kLatchedLarge,  // latched, for long messages: allocates memory as needed
  kRequest,       // reliable, volatile, keep last kKeptRequests
  kReply,         // reliable, transient local, keep last kKeptReplies
};

// Before a request that was not acknowledged makes room for a further one, publish() waits for kReliableWriteTimeout at most: a reader that
// acknowledges nothing, as that of a stopped process, must not hold up a stop request.
constexpr int kKeptRequests = 64;
constexpr std::chrono::milliseconds kReliableWriteTimeout{200};
// Replies that reach a client whose reader is discovered only after they were sent.
constexpr int kKeptReplies = 32;

// A process announces itself once per period. After a lease without an announcement the others take it for
// dead.
constexpr std::chrono::milliseconds kLivelinessPeriod{400};
constexpr std::chrono::milliseconds kLivelinessLease{2000};
// Vehicle and motion capture announce themselves once per kFixturePeriod, and every process more often at its
// start: a controller that restarts in flight discovers them with their next announcement.
constexpr std::chrono::milliseconds kFixturePeriod{100};
constexpr int kFirstAnnouncements = 20;
constexpr std::chrono::milliseconds kFirstAnnouncementPeriod{25};

}  // namespace swiftlet::messages

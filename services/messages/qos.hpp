// The ways in which topics are delivered, and their numbers. idl/README.md shows them as a table.
#pragma once

#include <chrono>

namespace swiftlet::comms {

enum class Qos {
  kStream,        // best effort, keep last 1, volatile, preallocated
  kOwnedStream,   // a stream of which the strongest living writer is heard (exclusive ownership)
  kTelemetry,     // best effort, keep last 1, volatile
  kLatched,       // reliable, transient local, keep last 1
  kLatchedLarge,  // a state that may be long: takes memory as it needs it
  kRequest,       // reliable, volatile, keep all within limits
};

// Requests that may be under way between a writer and its readers before publish() waits, and how long it
// waits.
constexpr int kMaxPendingRequests = 64;
constexpr std::chrono::milliseconds kReliableWriteTimeout{200};

// A process says that it lives once in each period; after a lease without it the others take it for dead.
constexpr std::chrono::milliseconds kLivelinessPeriod{400};
constexpr std::chrono::milliseconds kLivelinessLease{2000};
// At its start more often, and vehicle and motion capture always: a controller that is started again in
// flight must find them at once, and hears of them with their next announcement.
constexpr std::chrono::milliseconds kFixturePeriod{100};
constexpr int kFirstAnnouncements = 20;
constexpr std::chrono::milliseconds kFirstAnnouncementPeriod{25};

}  // namespace swiftlet::comms

// How often a process sends a datagram of discovery in a domain of many processes. Fast DDS announces a process at a fixed
// period, and once more for each process that it discovers: n processes would take in n^2 announcements at rest, and n^3
// while they find each other.
#pragma once

#include <cstddef>
#include <cstdint>

#include "swiftlet/services/dds/datagram/token_bucket.hpp"

namespace swiftlet::comms {

// On a network that loses half of all datagrams, 98 % of those that tell of endpoints arrive with so many copies, and four
// announcements in a row are lost once in hours.
constexpr int kEndpointCopies = 6;
constexpr int kAnnouncementCopies = 4;

// Announcements that a process takes in from all others together, per second: these processes share the rate.
constexpr double kHeardAnnouncements = 300.0;
// Announcements of a process per second, however many others there are: four within kLivelinessLease.
constexpr double kLeastAnnouncements = 2.0;

// Of one process. Not thread-safe.
class AnnouncementBudget {
 public:
  // Returns how many copies of an announcement are sent now; 0 if the others share out the rate, and have this one
  // already. digest: of what it says; one that says something new is always sent, in all copies. processes: in the domain.
  // now_ns: of a monotonic clock.
  int copies(std::uint64_t digest, std::size_t processes, std::int64_t now_ns);

 private:
  TokenBucket tokens_{kBurst, 0.0};
  std::uint64_t last_digest_ = 0;

  static constexpr double kBurst = 20.0;  // the first announcements of a process
};

// Returns how many copies are sent of a datagram that tells of endpoints.
int endpoint_copies(std::size_t processes);

}  // namespace swiftlet::comms

// How often a process sends a datagram of discovery in a domain of many processes. Fast DDS announces a process at a fixed
// period, and once more for each process that it discovers: n processes would take in n^2 announcements at rest, and n^3
// while they find each other.
#pragma once

#include <cstddef>
#include <cstdint>

#include "swiftlet/services/runtime/token_bucket.hpp"

namespace swiftlet::dds {

// On a network that loses half of all datagrams, 98 % of those that tell of endpoints arrive with so many copies, and four
// announcements in a row are lost once in hours.
constexpr int kEndpointCopies = 6;
constexpr int kAnnouncementCopies = 4;
// A message of the handshake of DDS Security is sent so often. Fast DDS drops the answer that arrives while it still sends the copies, and
// repeats the message after 1 s.
constexpr int kHandshakeCopies = 2;

// Announcements that a process takes in from all others together, per second: these processes share the rate.
constexpr double kHeardAnnouncements = 300.0;
// In a domain of many processes, of those that go to anyone, most of whom need not know of each other; and so many that all
// processes together take in, which may run on one host.
constexpr double kHeardByAnyone = 100.0;
constexpr double kHeardByAll = 10'000.0;
// Announcements per second to a process that is known, however many others there are: four within kLivelinessLease.
constexpr double kLeastAnnouncements = 2.0;

// The announcements of one process to one destination. Not thread-safe.
class AnnouncementBudget {
 public:
  // Returns how many copies of an announcement are sent now; 0 if the others share out the rate, and the destination has
  // this one already. digest: of what it says; one that says something new is always sent. processes: in the domain.
  // joined_ns: when the latest process at the destination was discovered, which is always answered; 0: none is known there,
  // or the destination is a multicast address. now_ns: of the same monotonic clock.
  int copies(std::uint64_t digest, std::size_t processes, std::int64_t joined_ns, std::int64_t now_ns);

 private:
  runtime::TokenBucket tokens_{kBurst, 0.0};
  std::uint64_t last_digest_ = 0;
  std::int64_t last_ns_ = 0;  // 0: none was sent

  static constexpr double kBurst = 20.0;  // the first announcements of a process
};

// Returns how many copies are sent of a datagram that tells of endpoints.
int endpoint_copies(std::size_t processes);

}  // namespace swiftlet::dds

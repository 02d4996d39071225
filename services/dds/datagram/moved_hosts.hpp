// Where hosts are reached whose addresses have changed: at the address from which they are heard now. Fast DDS keeps sending to
// the addresses that a process announced first, or while it had no network.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "swiftlet/services/dds/datagram/parameter_list.hpp"

namespace swiftlet::comms {

// heard() and take_news() are called by one thread at a time, now_at() and any() by all others meanwhile. Allocates only for news.
class MovedHosts {
 public:
  // A host that moves has been silent at its old address for so long, s. A recording of an announcement that somebody sends
  // while the host is heard thus moves nothing.
  static constexpr std::int64_t kSilence_ns = 1'000'000'000;

  struct Move {
    Ipv4 announced;
    Ipv4 heard_at;  // equal to `announced`: it is back
  };

  // is_own: whether this host has the address now.
  explicit MovedHosts(bool (*is_own)(Ipv4)) : is_own_(is_own) {}

  // A participant that announces these addresses for its samples was heard from `source`. now_ns: of a monotonic clock.
  void heard(const Announced& said, Ipv4 source, std::int64_t now_ns);

  // Whether there is a host that has moved.
  bool any() const { return moved_.load(std::memory_order_relaxed) > 0; }
  // Where to send what is for this address.
  Ipv4 now_at(Ipv4 announced) const;

  // The moves since the last call, but for those to the loopback interface.
  std::vector<Move> take_news();

 private:
  struct Host {
    std::atomic<std::uint64_t> addresses{0};  // announced in the upper half, in use in the lower one
    std::int64_t heard_ns = 0;
  };

  Host& host(Ipv4 announced);
  void use(Host& host, Ipv4 announced, Ipv4 address);

  bool (*const is_own_)(Ipv4);
  std::array<Host, 256> hosts_{};  // the longest silent one is forgotten
  std::atomic<int> moved_{0};
  std::vector<Move> news_;
};

}  // namespace swiftlet::comms

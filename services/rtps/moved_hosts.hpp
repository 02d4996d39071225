// Where hosts are reached whose addresses have changed: at the address from which they are heard now. Fast DDS keeps sending to
// the addresses that a process announced first, or while it had no network.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <boost/container/static_vector.hpp>

#include "swiftlet/services/rtps/parameter_list.hpp"

namespace swiftlet::rtps {

// any() is called by all threads, the others by one at a time. Allocates only in set_own().
class MovedHosts {
 public:
  // A host that moves has been silent at its old address for so long. A recording of an announcement that somebody sends
  // while the host is heard thus moves nothing.
  static constexpr std::int64_t kSilence_ns = 1'000'000'000;

  struct Move {
    Ipv4 announced;
    Ipv4 heard_at;  // equal to `announced`: it is back
  };

  static constexpr std::size_t kMostNews = 16;
  using News = boost::container::static_vector<Move, kMostNews>;

  // The addresses that this host has now. Its processes announce themselves over the loopback interface, too.
  void set_own(std::vector<Ipv4> own) { own_.swap(own); }

  // A participant that announces these addresses for its samples was heard from `source`. now_ns: of a monotonic clock.
  void heard(const Announced& said, Ipv4 source, std::int64_t now_ns);

  // Whether there is a host that has moved.
  bool any() const { return moved_.load(std::memory_order_relaxed) > 0; }
  // Where to send what is for this address.
  Ipv4 now_at(Ipv4 announced) const;

  // The moves since the last call, but for those to the loopback interface.
  News take_news() { return std::exchange(news_, {}); }

 private:
  struct Host {
    Ipv4 announced;
    Ipv4 used;
    std::int64_t heard_ns;
  };

  Host& host(Ipv4 announced);
  void use(Host& host, Ipv4 address);

  std::vector<Ipv4> own_;
  boost::container::static_vector<Host, 256> hosts_;  // the longest silent one is forgotten
  std::atomic<int> moved_{0};
  News news_;
};

}  // namespace swiftlet::rtps

// Peers that were taken for dead and come back as they were.
#pragma once

#include <chrono>
#include <map>

namespace swiftlet::comms {

// Both sides forget each other when a network is cut. When only one process was away (stopped, or starved of
// its cores), the others forget it, but it may remember them; then Fast DDS 2.9 does not always tell them its
// endpoints again, and they do not hear each other for good. Such a peer is known by coming back without the
// kinds of endpoints that it had.
template <class Id>
class RediscoveryMonitor {
 public:
  using Time = std::chrono::steady_clock::time_point;
  enum Kind : unsigned { kWriter = 1, kReader = 2 };

  void came(const Id& peer, Time now) {
    Peer& it = peers_[peer];
    it.since = now;
    it.present = 0;
  }
  void has(const Id& peer, Kind endpoint) {
    Peer& it = peers_[peer];
    it.present |= endpoint;
    it.known |= endpoint;
  }
  void lost(const Id& peer) { peers_[peer].since = Time::max(); }  // its lease ran out
  void gone(const Id& peer) { peers_.erase(peer); }                // it said goodbye
  void clear() { peers_.clear(); }

  // A peer is back for that long, and not all of it.
  bool failed(Time now, std::chrono::milliseconds patience) const {
    for (const auto& [id, peer] : peers_) {
      if (peer.present != peer.known && now - patience > peer.since) return true;
    }
    return false;
  }

 private:
  struct Peer {
    Time since;            // it came; Time::max(): it is lost
    unsigned present = 0;  // kinds of endpoints since then
    unsigned known = 0;    // ever
  };
  std::map<Id, Peer> peers_;
};

}  // namespace swiftlet::comms

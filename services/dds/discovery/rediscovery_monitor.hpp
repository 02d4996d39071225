// Detects peers whose rediscovery after a lost lease is incomplete.
#pragma once

#include <chrono>
#include <cstddef>
#include <deque>
#include <map>

namespace swiftlet::comms {

// When a network is cut, both sides drop each other. When only one process was away (stopped, or starved of
// CPU time), the others drop it, but it may still know them. Fast DDS 2.9 then does not always announce its
// endpoints again, and the processes never receive each other. Such a peer is rediscovered without the kinds
// of endpoints that it had before.
template <class Id>
class RediscoveryMonitor {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr std::size_t kMostLost = 256;
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
  // Its lease expired. Of many that never return, those that were lost first are forgotten.
  void lost(const Id& peer) {
    Peer& it = peers_[peer];
    if (it.since != Time::max()) lost_.push_back(peer);
    it.since = Time::max();
    for (; lost_.size() > kMostLost; lost_.pop_front()) {
      const auto first = peers_.find(lost_.front());
      if (first != peers_.end() && first->second.since == Time::max()) peers_.erase(first);
    }
  }
  void gone(const Id& peer) { peers_.erase(peer); }  // it left the domain
  void clear() {
    peers_.clear();
    lost_.clear();
  }

  std::size_t size() const { return peers_.size(); }

  // True if a peer was rediscovered longer than patience ago and still lacks a kind of endpoint.
  bool failed(Time now, std::chrono::milliseconds patience) const {
    for (const auto& [id, peer] : peers_) {
      if (peer.present != peer.known && now - patience > peer.since) return true;
    }
    return false;
  }

 private:
  struct Peer {
    Time since;            // its discovery; Time::max(): lost
    unsigned present = 0;  // kinds of endpoints seen since then
    unsigned known = 0;    // kinds of endpoints ever seen
  };
  std::map<Id, Peer> peers_;
  std::deque<Id> lost_;  // in their order, some of which have returned
};

}  // namespace swiftlet::comms

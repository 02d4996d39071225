// When a process leaves the domain and joins it again, because a peer was rediscovered incompletely.
//
// When a network is cut, both sides drop each other. When only one process was away (stopped, or starved of CPU time), the others
// drop it, but it may still know them. Fast DDS 2.9 then does not always announce its endpoints again, and the processes never
// receive each other.
#pragma once

#include <algorithm>
#include <chrono>

namespace swiftlet::dds {

// Which kinds of endpoints of a peer are known.
struct PeerEndpoints {
  using Time = std::chrono::steady_clock::time_point;
  enum Kind : unsigned { kWriter = 1, kReader = 2 };

  Time discovered{};  // the peer
  unsigned known = 0;
  unsigned before = 0;  // known before its lease expired, if it did

  // Whether it was rediscovered longer than patience ago and still lacks a kind of endpoint.
  bool are_missing(Time now, std::chrono::milliseconds patience) const {
    return (before & ~known) != 0 && now - patience > discovered;
  }
};

// A rejoin makes all peers discover a new process. On a host without enough CPU time that may make them rejoin in turn:
// therefore each further rejoin waits twice as long, and processes that began together wait differently long.
class RejoinPatience {
 public:
  using Time = PeerEndpoints::Time;
  static constexpr std::chrono::milliseconds kFirst{1000};
  static constexpr int kMostDoublings = 4;
  static constexpr std::chrono::seconds kQuiet{60};  // without a rejoin, until it begins again with kFirst

  // spread: 0 to 1, of this process. It prolongs all times but the first by up to a half.
  explicit RejoinPatience(double spread) : spread_(spread) {}

  std::chrono::milliseconds at(Time now) const {
    const int doublings = doublings_at(now);
    if (doublings == 0) return kFirst;
    return std::chrono::duration_cast<std::chrono::milliseconds>(kFirst * (1 << doublings) *
                                                                 (1.0 + 0.5 * spread_));
  }
  void rejoined(Time now) {
    doublings_ = std::min(doublings_at(now) + 1, kMostDoublings);
    last_ = now;
  }

 private:
  int doublings_at(Time now) const { return now - last_ > kQuiet ? 0 : doublings_; }

  double spread_;
  int doublings_ = 0;
  Time last_{};
};

}  // namespace swiftlet::dds
